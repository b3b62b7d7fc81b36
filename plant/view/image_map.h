// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Where things on the plate are in the flat picture, which the renderer paints.
#include "core/camera/camera_geometry.h"

#include <cmath>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// The similarity (scale and rotation) that maps the plate to the flat picture: what the camera would see if
/// it looked straight at the plate. Without tilt, distortion, unequal focal lengths and an oblique axis the
/// flat picture is the image; otherwise pixel_map.h warps it into the image.
class ImageMap {
  public:
    /// @param foot_mm  plate point beneath the camera's centre at s = 0
    ImageMap(const CameraGeometry& camera, const Eigen::Vector2d& foot_mm)
        : camera_(camera),
          foot_mm_(foot_mm),
          px_per_mm_(1.0 / mm_per_px(camera)),
          straight_(looks_straight(camera)),
          axis_(Eigen::Vector3d(1.0, camera.axis_rad.x(), camera.axis_rad.y()).normalized()) {
        const double c = std::cos(camera.rotation_rad), s = std::sin(camera.rotation_rad);
        turn_ << c, -s, s, c;
    }

    /// Whether the flat picture is the image.
    bool is_image() const {
        return camera_.distortion.is_none() && camera_.focal_ratio == 1.0 && camera_.tilt_rad.isZero(0.0) &&
               camera_.axis_rad.isZero(0.0);
    }
    /// Place in the flat picture, px, of a plate point seen from camera position s.
    Eigen::Vector2d place(const Eigen::Vector2d& plate_mm, double s_mm) const {
        if (straight_) return project(camera_, plate_mm - foot_mm_, s_mm);
        const Eigen::Vector2d from_foot = plate_mm - foot_mm_ - s_mm * axis_.head<2>();
        return camera_.principal_point_px + displacement_px(from_foot * growth(s_mm));
    }
    /// Where a ray from the camera at s = 0 meets the flat picture.
    /// @param slope  x and y per z in the plate's frame
    Eigen::Vector2d place_of_ray(const Eigen::Vector2d& slope) const {
        return camera_.principal_point_px + displacement_px(slope * camera_.distance_mm);
    }
    /// Factor by which things appear larger from s than from 0, as an oblique axis brings the camera nearer.
    double growth(double s_mm) const {
        return camera_.distance_mm / (camera_.distance_mm - s_mm * axis_.z());
    }
    /// A displacement on the plate as one in the flat picture, px.
    Eigen::Vector2d displacement_px(const Eigen::Vector2d& step_mm) const {
        if (camera_.rotation_rad == 0.0) return step_mm * px_per_mm_;
        return turn_ * step_mm * px_per_mm_;
    }
    double length_px(double length_mm) const { return length_mm * px_per_mm_; }
    /// The flat picture's shift in px along the direction of plate x when the camera moves by step_mm; the
    /// picture shifts against the camera's motion.
    double shift_px(double step_mm) const { return -step_mm * px_per_mm_; }
    /// Whether the direction of plate x is u.
    bool shifts_along_u() const { return camera_.rotation_rad == 0.0; }
    /// An angle from plate x towards y, as an angle from u towards v.
    double angle_rad(double plate_angle_rad) const { return plate_angle_rad + camera_.rotation_rad; }

  private:
    CameraGeometry camera_;
    Eigen::Vector2d foot_mm_;
    double px_per_mm_;
    bool straight_;
    Eigen::Vector3d axis_;
    Eigen::Matrix2d turn_;
};

}  // namespace fidservo::plant::view
