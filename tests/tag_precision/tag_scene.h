// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The mean picture of one printed tag under a camera, as a function of all influences. Exact to rounding for
// a camera without noise; it shares no code with the program's own rendering.
#include "core/camera/camera_geometry.h"
#include "core/detection.h"
#include "tests/tag_precision/blurred_region.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace fidservo::precision {

/// Light on the plate: 1 + gradient . r + vignetting |r|^2, r from the image's middle in half widths.
struct Illumination {
    double level = 1.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    double vignetting = 0.0;
};

/// A foreign object on the tag. Its outline is given on the tag: (-0.5, -0.5) is the corner of least plate x
/// and y, (0.5, 0.5) the opposite one. It is blurred like the tag, and covers it.
struct Cover {
    std::vector<Eigen::Vector2d> outline;  ///< clockwise as seen in the image
    double level;                          ///< fraction of full scale
};

/// A reflex: light added to the picture, level exp(-(r / radius)^2 / 2) around a point of the tag.
struct Glare {
    Eigen::Vector2d at;  ///< in the same coordinates as outlines
    double radius_px;
    double level;  ///< fraction of full scale
};

struct TagScene {
    int tag_id = 0;
    Eigen::Vector2d centre_px{319.5, 239.5};  ///< image of the tag's centre
    double side_px = 320.0;                   ///< if the camera looks straight down
    double angle_rad = 0.0;                   ///< on the plate, from x towards y
    CameraGeometry camera{640, 480, 5000.0, {319.5, 239.5}, 20.0};
    /// Distance by which every black edge is moved outwards, corners staying square.
    double ink_spread_px = 0.0;
    double black = 0.07;  ///< fractions of full scale
    double white = 0.70;
    Blur blur;
    Illumination illumination;
    std::optional<Cover> cover;
    std::optional<Glare> glare;

    cv::Size size_px() const { return {camera.width_px, camera.height_px}; }
};

/// Where a point of the tag appears; (0, 0) is its centre, its corners are at +-0.5.
Eigen::Vector2d image_of(const TagScene& scene, const Eigen::Vector2d& on_tag);

/// In detection order.
std::array<Eigen::Vector2d, 4> corners_of(const TagScene& scene);

/// Fraction of black ink (0..1) that every pixel sees.
cv::Mat1d ink_picture(const TagScene& scene);

/// Fraction of full scale that every pixel would show without noise and saturation.
cv::Mat1d mean_picture(const TagScene& scene);

/// 255 where the picture is that of the tag alone, 0 where cover or glare change it by more than a grey
/// level.
cv::Mat1b undamaged(const TagScene& scene);

}  // namespace fidservo::precision
