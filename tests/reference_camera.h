// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/camera/camera_parameters.h"

namespace fidservo {

/// The reference rig's camera, for tests and benchmarks that read no rig file. Corner noise and speed limit,
/// which only apply to detections without images, are zero.
inline CameraParameters reference_camera() {
    return {.geometry = {1280, 960, 5000.0, {639.5, 479.5}, 20.0},
            .frame_rate_hz = 50.0,
            .exposure_s = 0.002,
            .full_well_e = 10000.0,
            .read_noise_e = 5.0,
            .blur_px = 0.8,
            .latency_s = 0.03,
            .corner_noise_px = 0.0,
            .max_speed_mm_per_s = 0.0};
}

}  // namespace fidservo
