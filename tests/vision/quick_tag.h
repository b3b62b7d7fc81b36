// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fast drawing of tags for tests with thousands of pictures: four samples per pixel, so that edges are
// accurate to about a fifth of a pixel.
#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::vision::testing {

/// What is printed in 8 x 8 cells, true is white; the cells' size and place in the image.
struct QuickTag {
    std::array<std::array<bool, 8>, 8> white;
    Eigen::Vector2d centre_px;
    double side_px;
    double angle_rad = 0.0;  ///< from u towards v
    double black = 30.0;     ///< grey levels
    double paper = 220.0;
};

/// The cells for an id, drawn by the library.
std::array<std::array<bool, 8>, 8> cells_of(int tag_id);
/// The same print, turned by a quarter turn from u towards v.
std::array<std::array<bool, 8>, 8> turned(const std::array<std::array<bool, 8>, 8>& cells);

/// Corners in detection order, pixel centres at integers.
std::array<Eigen::Vector2d, 4> corners_of(const QuickTag& tag);

struct QuickPicture {
    cv::Size size_px{240, 180};
    double paper = 220.0;
    double noise_grey = 2.0;
    int motion_blur_px = 1;  ///< along u
    std::uint64_t seed = 1;
};

cv::Mat draw(const std::vector<QuickTag>& tags, const QuickPicture& how);

}  // namespace fidservo::vision::testing
