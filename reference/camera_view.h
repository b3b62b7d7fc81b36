// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The fiducial that the camera sees, computed without images: a pinhole camera that may be tilted; its
// corners have noise.
#include "core/camera/camera_parameters.h"
#include "core/detection.h"
#include "core/fiducial_parameters.h"
#include "core/random.h"
#include "reference/departures.h"

#include <optional>

namespace fidservo::reference {

struct CameraModel {
    CameraParameters camera;
    FiducialParameters fiducials;
    CameraDepartures departures;
};

/// Image of a plate point, seen from camera position s: the point on the plate under the optical axis of a
/// camera that is not tilted, at the rig's distance along the axis. In px, pixel centres at integers. Let a
/// be the coordinate along the tilt's axis, b the one across it, h the axis's height over the plate, theta
/// the tilt:
///
///     depth = Z + b sin theta - h (1 - cos theta),   (a, b)' = (a, b cos theta - h sin theta) / depth
///     (u, v) = (u0, v0) + scale f diag(1, aspect) R(rho) (x, y) (1 + k1 r^2) / (1 - k r^2),   r^2 = x^2 +
///     y^2
///
/// (x, y) is (a, b)' resolved along u and v; rho is the image's rotation.
Eigen::Vector2d image_of(const CameraModel& model, const Eigen::Vector2d& plate_mm, double s_mm);

/// The tag nearest to the image centre; empty unless all of it is in the image and the camera is slow enough.
std::optional<TagDetection> see(const CameraModel& model, double s_mm, double speed_mm_per_s,
                                NoiseStream& noise);

/// Time in s at which frame k is exposed. The frames are counted by the camera's own clock.
double exposure_s(const CameraModel& model, std::int64_t frame);

/// The time stamp of frame k.
TimeNs stamp_ns(const CameraModel& model, std::int64_t frame);

}  // namespace fidservo::reference
