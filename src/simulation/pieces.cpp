// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo {

namespace {

/// Whether a phase that runs from `from` to `to` passes `angle`, or `angle` and whole turns.
bool passes(double from, double to, double angle) {
    constexpr double turn = 2.0 * std::numbers::pi;
    return angle + turn * std::ceil((from - angle) / turn) <= to;
}

}  // namespace

double value_at(const Piece& piece, double t_s) {
    return piece.base + piece.per_s * t_s +
           piece.amplitude * std::sin(piece.omega_rad_per_s * t_s + piece.phase_rad);
}

std::pair<double, double> extremes(const Piece& piece) {
    auto [low, high] = std::minmax({value_at(piece, 0.0), value_at(piece, piece.duration_s)});
    const double end_rad = piece.phase_rad + piece.omega_rad_per_s * piece.duration_s;
    // A piece is a ramp or a sine: the crests of the sine are at its base.
    if (passes(piece.phase_rad, end_rad, 0.5 * std::numbers::pi))
        high = std::max(high, piece.base + piece.amplitude);
    if (passes(piece.phase_rad, end_rad, -0.5 * std::numbers::pi))
        low = std::min(low, piece.base - piece.amplitude);
    return {low, high};
}

double duration_s(const std::vector<Piece>& pieces) {
    double sum_s = 0.0;
    for (const Piece& piece : pieces) sum_s += piece.duration_s;
    return sum_s;
}

Course course_of(const std::vector<Piece>& pieces, Follows follows) {
    if (std::ranges::count(pieces, follows, &Piece::follows) == 0) return {};
    std::vector<double> starts_s{0.0};
    for (const Piece& piece : pieces) starts_s.push_back(starts_s.back() + piece.duration_s);
    return [=](double t_s) {
        constexpr double rounding_s = 1e-9;
        const auto next = std::ranges::upper_bound(starts_s, t_s + rounding_s);
        if (next == starts_s.begin() || next == starts_s.end()) return not_in_force;
        const auto k = static_cast<std::size_t>(next - starts_s.begin()) - 1;
        return pieces[k].follows == follows ? value_at(pieces[k], std::max(0.0, t_s - starts_s[k]))
                                            : not_in_force;
    };
}

}  // namespace fidservo
