// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Derivatives of core/camera/camera_geometry.h's projection, in its symbols: how an image point moves with
// a plate point and back. Also the unit vectors that enter the projection.
#include "core/camera/camera_geometry.h"

namespace fidservo {

/// The stage's axis a in the plate's frame, a unit vector.
Eigen::Vector3d stage_axis(const CameraGeometry& camera);

/// (x', y') of an image point: from the principal point, in focal lengths.
Eigen::Vector2d pictured_at(const CameraGeometry& camera, const Eigen::Vector2d& image_px);

/// (x, y) of an image point: where a pinhole at unit distance would see it. NaN where the lens images no ray
/// from ahead of the camera there.
Eigen::Vector2d ideal_point(const CameraGeometry& camera, const Eigen::Vector2d& image_px);

/// d (x, y) / d (u, v) of ideal_point(), 1/px.
Eigen::Matrix2d ideal_by_image(const CameraGeometry& camera, const Eigen::Vector2d& image_px);

/// d (X, Y) / d (u, v) of back_project(), mm per px. (Z / f) I for a camera that looks straight down.
Eigen::Matrix2d plate_by_image(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm);

/// Length on the plate of a pixel at an image point: square root of plate_by_image()'s determinant.
double mm_per_px_at(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm);

/// Whether the lens images one direction at most to each point of the image. For a plumb_bob lens: d (x', y')
/// / d (x, y) keeps its sign from the principal point to every place of the image's rim. An equidistant lens
/// may show a circle that is smaller than the image; the circle has to reach at least the nearest side of the
/// image.
bool lens_is_one_to_one(const CameraGeometry& camera);

}  // namespace fidservo
