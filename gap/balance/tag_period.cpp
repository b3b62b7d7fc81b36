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

/// Of the carriage at each detection of the tags' windows, in their order.
std::vector<double> positions_mm(const Evidence& evidence) {
    std::vector<double> positions;
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::tag) continue;
        for (std::size_t i = 0; window.begin + corner_values * i < window.end; ++i)
            positions.push_back(sight_of(evidence, window.run, window.first_detection + i).position_mm);
    }
    return positions;
}

}  // namespace

double strongest_tag_period_mm(const Evidence& evidence, const Errors& errors) {
    constexpr double shortest_mm = 1.0, turns_apart = 0.25;
    const std::vector<double> places = positions_mm(evidence);
    if (places.empty()) return 0.0;
    const auto [low, high] = std::ranges::minmax(places);
    const double step_per_mm = turns_apart / std::max(longest_period_mm, high - low);
    double best_mm = 0.0, most = 0.0;
    for (double per_mm = 1.0 / longest_period_mm; per_mm <= 1.0 / shortest_mm; per_mm += step_per_mm) {
        Eigen::Matrix2d normal = Eigen::Matrix2d::Identity() * next_to_nothing;
        Eigen::Vector2d right = Eigen::Vector2d::Zero();
        std::size_t at = 0;
        for (const Window& window : evidence.windows()) {
            if (window.signal != Signal::tag) continue;
            Eigen::Matrix3d own = Eigen::Matrix3d::Zero();  // of sine, cosine, error, about their means
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            double count = 0.0;
            for (std::size_t k = window.begin; k < window.end; k += corner_values, ++at) {
                if (std::isnan(errors[k])) continue;
                const double phase = 2.0 * std::numbers::pi * per_mm * places[at];
                const Eigen::Vector3d row(std::sin(phase), std::cos(phase), errors[k]);
                own += row * row.transpose();
                sum += row;
                count += 1.0;
            }
            if (count <= 2.0) continue;
            own -= sum * sum.transpose() / count;
            const double weight = 1.0 / (count + own(2, 2));
            normal += weight * own.topLeftCorner<2, 2>();
            right += weight * own.topRightCorner<2, 1>();
        }
        const double taken = right.dot(normal.inverse() * right);
        if (taken <= most) continue;
        most = taken;
        best_mm = 1.0 / per_mm;
    }
    return best_mm;
}

}  // namespace fidservo::gap
