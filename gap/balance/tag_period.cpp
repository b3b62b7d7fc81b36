// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/tag_period.h"

#include "gap/balance/period_search.h"
#include "gap/links/tag_sight.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>

namespace fidservo::gap {
namespace {

/// At each detection of the tags' windows, in their order.
std::vector<double> positions_mm(const Evidence& evidence, WaveOf wave) {
    std::vector<double> positions;
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::tag) continue;
        for (std::size_t i = 0; window.begin + corner_values * i < window.end; ++i) {
            const TagSight sight = sight_of(evidence, window.run, window.first_detection + i);
            positions.push_back(sight.position_mm + (wave == WaveOf::camera ? sight.contraction_mm : 0.0));
        }
    }
    return positions;
}

}  // namespace

double strongest_tag_period_mm(const Evidence& evidence, const Errors& errors, WaveOf wave) {
    constexpr double shortest_mm = 1.0, turns_apart = 0.25;
    const std::vector<double> places = positions_mm(evidence, wave);
    if (places.empty()) return 0.0;
    const auto [low, high] = std::ranges::minmax(places);
    const double step_per_mm = turns_apart / std::max(longest_period_mm, high - low);
    const auto taken = [&](double per_mm) {
        constexpr int unknowns = Eigen::Matrix3d::RowsAtCompileTime;  // sine, cosine and a constant
        Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * next_to_nothing;
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        std::size_t at = 0;
        for (const Window& window : evidence.windows()) {
            if (window.signal != Signal::tag) continue;
            Eigen::Matrix4d own = Eigen::Matrix4d::Zero();  // of sine, cosine, constant, error
            for (std::size_t k = window.begin; k < window.end; k += corner_values, ++at) {
                if (std::isnan(errors[k])) continue;
                const double phase = 2.0 * std::numbers::pi * per_mm * places[at];
                const Eigen::Vector4d row(std::sin(phase), std::cos(phase), 1.0, errors[k]);
                own += row * row.transpose();
            }
            const double count = own(2, 2);
            if (count <= 2.0) continue;
            const Eigen::Vector4d sum = own.col(2);
            if (wave == WaveOf::carriage) own -= sum * sum.transpose() / count;
            const double weight = 1.0 / (count + own.bottomRightCorner<1, 1>().value());
            normal += weight * own.topLeftCorner<unknowns, unknowns>();
            right += weight * own.topRightCorner<unknowns, 1>();
        }
        return right.dot(normal.inverse() * right);
    };
    double best_per_mm = 0.0, most = 0.0;
    const auto try_at = [&](double per_mm) {
        const double here = taken(per_mm);
        if (here <= most) return;
        most = here;
        best_per_mm = per_mm;
    };
    for (double per_mm = 1.0 / longest_period_mm; per_mm <= 1.0 / shortest_mm; per_mm += step_per_mm)
        try_at(per_mm);
    if (best_per_mm == 0.0) return 0.0;
    constexpr int halvings = 6;
    double step = 0.5 * step_per_mm;
    for (int k = 0; k < halvings; ++k, step *= 0.5) {
        const double middle = best_per_mm;
        try_at(middle - step);
        try_at(middle + step);
    }
    return 1.0 / best_per_mm;
}

}  // namespace fidservo::gap
