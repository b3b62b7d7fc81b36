// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One straight edge in the image, as a shape for fit_outline().
#include "vision/features/outline_fit.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace fidservo::vision {

/// Its parameters: shift along the normal at the middle, px, and rotation, rad (positive from x towards y).
struct StraightEdge {
    static constexpr int parameters = 2;
    static constexpr double section_px = 6.0;
    Eigen::Vector2d middle_px;
    Eigen::Vector2d along;    ///< unit vector
    Eigen::Vector2d outward;  ///< unit normal, away from the ink
    double length_px;

    std::vector<OutlineSection<parameters>> sections(const cv::Mat& grey, const Reach& reach) const {
        const int count = std::max(1, static_cast<int>(length_px / section_px));
        const Eigen::Vector2d half = 0.5 * length_px * along;
        auto samples = samples_of_band(grey, middle_px - half, middle_px + half, outward, reach, count);
        const double handed = along.x() * outward.y() - along.y() * outward.x();  // +-1
        std::vector<OutlineSection<parameters>> found;
        for (int k = 0; k < count; ++k) {
            const double arm = ((k + 0.5) / count - 0.5) * length_px;
            found.push_back({std::move(samples[k]), {1.0, handed * arm}});
        }
        return found;
    }

    void correct(const Eigen::Vector2d& correction) {
        middle_px += correction[0] * outward;
        const double c = std::cos(correction[1]);
        const double s = std::sin(correction[1]);
        along = Eigen::Vector2d(c * along.x() - s * along.y(), s * along.x() + c * along.y());
        outward = Eigen::Vector2d(c * outward.x() - s * outward.y(), s * outward.x() + c * outward.y());
    }
};

}  // namespace fidservo::vision
