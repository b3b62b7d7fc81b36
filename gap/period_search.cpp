#include "gap/period_search.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <span>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

constexpr double shortest_mm = 0.8, longest_mm = 50.0;
constexpr std::size_t every = 4;  ///< rows that are compared; the carriage is followed through all

using Rows = Eigen::Index;

/// A window's rows, ready for waves of any period.
struct Stretch {
    std::vector<float> position_mm;
    std::vector<char> moves;
    std::vector<Rows> compared;
    Eigen::MatrixXd start;   ///< orthonormal: what an unknown state at the start adds
    Eigen::VectorXd errors;  ///< without that
    double weight = 0.0;
    std::vector<std::complex<float>> wave, turn;  ///< exp(i k y) and its change from one k to the next
};

Stretch stretch_of(const Evidence& evidence, const Window& window, const Errors& errors) {
    const Course& course = evidence.course(window.run);
    const double decay = evidence.rig().macro.velocity_pole;
    Stretch stretch;
    double way = 0.0, velocity = 1.0;
    std::vector<double> ways, values;
    for (std::size_t k = 0; k < window.rows; ++k) {
        const std::size_t row = window.first_row + k;
        stretch.position_mm.push_back(course.position_mm[row]);
        stretch.moves.push_back(std::abs(course.velocity_mm_per_s[row]) > moving_mm_per_s);
        const float error = errors[window.begin + k];
        if (k % every == 0 && !std::isnan(error)) {
            stretch.compared.push_back(static_cast<Rows>(k));
            ways.push_back(way);
            values.push_back(error);
        }
        velocity *= decay;
        way += velocity;
    }
    const auto height = static_cast<Rows>(values.size());
    if (height < 8 || std::ranges::count(stretch.moves, 1) == 0) return {};
    Eigen::MatrixXd start(height, 2);
    start.col(0).setOnes();
    start.col(1) = Eigen::Map<const Eigen::VectorXd>(ways.data(), height);
    stretch.start =
        Eigen::HouseholderQR<Eigen::MatrixXd>(start).householderQ() * Eigen::MatrixXd::Identity(height, 2);
    const Eigen::Map<const Eigen::VectorXd> all(values.data(), height);
    stretch.errors = all - stretch.start * (stretch.start.transpose() * all);
    stretch.weight = 1.0 / (static_cast<double>(height) + all.squaredNorm());
    return stretch;
}

/// Sums of weighted least squares of four columns.
struct Normal {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
};

/// Of a column's way, that numbers are of one size: in ticks of the velocity that the force would sustain.
constexpr double way_unit = 1e-2;

/// Sine and cosine of the position, as readings and as what they do as forces.
void add(Normal& normal, const Stretch& stretch, double decay) {
    const auto height = static_cast<Rows>(stretch.compared.size());
    Eigen::Matrix<double, Eigen::Dynamic, 4> columns(height, 4);
    std::complex<double> velocity = 0.0, way = 0.0;
    Rows next = 0;
    for (std::size_t k = 0; k < stretch.wave.size() && next < height; ++k) {
        const std::complex<double> wave(stretch.wave[k]);
        if (static_cast<Rows>(k) == stretch.compared[static_cast<std::size_t>(next)])
            columns.row(next++) << wave.real(), wave.imag(), way.real(), way.imag();
        velocity = stretch.moves[k] != 0 ? decay * velocity + (1.0 - decay) * wave : 0.0;
        way += way_unit * velocity;
    }
    columns -= stretch.start * (stretch.start.transpose() * columns);
    normal.matrix += stretch.weight * columns.transpose() * columns;
    normal.right += stretch.weight * columns.transpose() * stretch.errors;
}

/// The wave whose lack leaves errors of these shares of cosine and sine.
Wave wave_of(const Eigen::Vector2d& cosine_sine, double unit) {
    return {unit * cosine_sine.norm(), std::atan2(-cosine_sine.x(), -cosine_sine.y())};
}

/// The highest of a periodogram, none beside a higher one.
std::vector<PositionPeriod> peaks(std::span<const PositionPeriod> all) {
    constexpr std::size_t most = 6, apart = 3;
    std::vector<std::size_t> order(all.size()), chosen;
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, std::greater{}, [&](std::size_t k) { return all[k].share; });
    for (const std::size_t k : order) {
        const bool is_beside = std::ranges::any_of(
            chosen, [&](std::size_t other) { return k < other + apart && other < k + apart; });
        if (!is_beside && chosen.size() < most) chosen.push_back(k);
    }
    std::vector<PositionPeriod> found;
    found.reserve(chosen.size());
    for (const std::size_t k : chosen) found.push_back(all[k]);
    return found;
}

}  // namespace

std::vector<PositionPeriod> strongest_periods(const Evidence& evidence, const Errors& errors,
                                              const Wanted& wanted) {
    std::vector<Stretch> stretches;
    double squares = 0.0, low_mm = 1e9, high_mm = -1e9;
    for (std::size_t w = 0; w < evidence.windows().size(); ++w) {
        const Window& window = evidence.windows()[w];
        if (wanted[w] == 0 || window.signal != Signal::encoder) continue;
        Stretch stretch = stretch_of(evidence, window, errors);
        if (stretch.compared.empty()) continue;
        squares += stretch.weight * stretch.errors.squaredNorm();
        const auto [low, high] = std::ranges::minmax(stretch.position_mm);
        low_mm = std::min<double>(low_mm, low);
        high_mm = std::max<double>(high_mm, high);
        stretches.push_back(std::move(stretch));
    }
    if (stretches.empty() || high_mm - low_mm < 2.0 * shortest_mm) return {};
    const double first = 1.0 / std::min(longest_mm, high_mm - low_mm), step = 0.5 / (high_mm - low_mm);
    for (Stretch& stretch : stretches)
        for (const float position_mm : stretch.position_mm) {
            const double angle = 2.0 * std::numbers::pi * position_mm;
            stretch.wave.emplace_back(std::polar(1.0, angle * first));
            stretch.turn.emplace_back(std::polar(1.0, angle * step));
        }
    const MacroParameters& macro = evidence.rig().macro;
    const double floor_mm = evidence.floor(Signal::encoder) * macro.encoder_resolution_mm;
    const double push_V = way_unit * floor_mm / (macro.velocity_gain_mm_per_s_per_V * evidence.rig().tick_s);
    std::vector<PositionPeriod> all;
    for (double per_mm = first; per_mm <= 1.0 / shortest_mm; per_mm += step) {
        Normal normal;
        for (Stretch& stretch : stretches) {
            add(normal, stretch, macro.velocity_pole);
            for (std::size_t k = 0; k < stretch.wave.size(); ++k) stretch.wave[k] *= stretch.turn[k];
        }
        const Eigen::Vector4d found = normal.matrix.completeOrthogonalDecomposition().solve(normal.right);
        all.push_back({1.0 / per_mm, found.dot(normal.right) / squares, wave_of(found.tail<2>(), push_V),
                       wave_of(found.head<2>(), floor_mm), step, 0.5 * (low_mm + high_mm)});
    }
    return peaks(all);
}

}  // namespace fidservo::gap
