// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera of a rig file (assets/rig.yaml), checked, in memory.
#include "core/camera/camera_covariance.h"
#include "core/camera/camera_geometry.h"

namespace fidservo {

/// A camera as its rig file describes it.
struct CameraParameters {
    CameraGeometry geometry;  ///< where it pictures a point of the plate
    double frame_rate_hz;     ///< frames a second
    double exposure_s;        ///< time that a pixel gathers light
    double full_well_e;       ///< electrons that make a pixel white
    double read_noise_e;      ///< standard deviation of a pixel's read noise, electrons
    double blur_px;           ///< standard deviation of the optical blur
    double latency_s;         ///< from the middle of the exposure to the frame's arrival
    /// Standard deviation of the corners in simulated detections that are not made from rendered images.
    double corner_noise_px;
    double max_speed_mm_per_s;  ///< in simulated detections no tag is seen above this speed
    double gain_spread = 0.0;   ///< standard deviation of the pixels' gains: a fixed pattern of noise
    /// Covariance of the geometry, as its calibration states it; zero: known exactly, or not stated.
    CameraCovariance geometry_covariance = CameraCovariance::Zero();
};

}  // namespace fidservo
