// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The reference rig's plate, seen by a camera with a smaller image (2.56 x 1.92 mm), rendered as the
// simulated camera renders it.
#include "core/plate.h"
#include "plant/view/plate_view.h"
#include "tests/reference_camera.h"
#include "tests/row_of_tags.h"

#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::devices {

inline constexpr const char* loopback_node = "/dev/video20";

inline CameraParameters loopback_camera() {
    CameraParameters camera = reference_camera();
    camera.geometry.width_px = 640;
    camera.geometry.height_px = 480;
    camera.geometry.principal_point_px = {319.5, 239.5};
    camera.frame_rate_hz = 10.0;
    return camera;
}

/// The frames of a camera at rest at places along the plate, mm.
inline std::vector<cv::Mat> frames_at(const std::vector<double>& places_mm) {
    const plant::PlateView view(loopback_camera(), row_of_tags(), {});
    std::vector<cv::Mat> frames;
    for (const double s_mm : places_mm)
        frames.push_back(view.render(std::vector<double>{s_mm}, frames.size()));
    return frames;
}

}  // namespace fidservo::devices
