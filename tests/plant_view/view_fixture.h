// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The reference rig's camera, and functions that evaluate rendered images.
#include "core/camera/camera_parameters.h"
#include "core/plate.h"
#include "plant/view/plate_view.h"
#include "tests/reference_camera.h"

#include <cmath>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::plant {

/// A camera of another image size, its axis through the middle, otherwise the reference rig's (4 um a pixel).
inline CameraParameters small_camera(int width_px, int height_px) {
    CameraParameters camera = reference_camera();
    camera.geometry.width_px = width_px;
    camera.geometry.height_px = height_px;
    camera.geometry.principal_point_px = {0.5 * (width_px - 1), 0.5 * (height_px - 1)};
    return camera;
}

/// No noise, and the same light everywhere.
inline ViewOptions ideal_view() {
    ViewOptions options;
    options.noise = false;
    options.light = {.level = 1.0, .gradient = {0.0, 0.0}, .vignetting = 0.0};
    return options;
}

/// A black plate with white things: grey levels are 255 times the coverage.
inline Plate dark_plate() {
    Plate plate;
    plate.paper_reflectance = 0.0;
    plate.ink_reflectance = 1.0;
    return plate;
}

inline cv::Mat render_at(const PlateView& view, double s_mm, std::uint64_t frame = 0) {
    return view.render(std::vector<double>{s_mm}, frame);
}

}  // namespace fidservo::plant
