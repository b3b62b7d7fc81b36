// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Frames with tags for tests of detection and refinement, from the exact pictures of tests/tag_precision/.
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision::testing {

struct RenderedTag {
    int id = 0;
    Eigen::Vector2d centre_px{320.0, 240.0};
    double side_px = 300.0;
    double angle_rad = 0.0;  ///< from u towards v
    double black = 25.0;     ///< grey levels
    double white = 229.0;
};

struct Rendering {
    cv::Size size_px{640, 480};
    double blur_px = 0.8;
    double full_well_e = 10000.0;  ///< of grey level 255
    double read_noise_e = 5.0;
    bool noise = true;
    std::uint64_t seed = 1;
};

/// Corners in detection order, pixel centres at integers.
std::array<Eigen::Vector2d, 4> corners_of(const RenderedTag& tag);

/// White paper with the tags on it.
cv::Mat render(const std::vector<RenderedTag>& tags, const Rendering& how);

}  // namespace fidservo::vision::testing
