#pragma once
// Where the plate's things are in the flat picture, for the painters.
#include "core/camera_geometry.h"
#include "plant/camera.h"

#include <cmath>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// The similarity (scale and rotation) that a camera makes of the plate: the same everywhere and at every
/// camera position. Without tilt and distortion it is the image; with them it is the flat picture that
/// pixel_map.h bends into the image.
class ImageMap {
  public:
    explicit ImageMap(const CameraGeometry& camera) : ImageMap(make_camera_optics(camera, {})) {}
    explicit ImageMap(const CameraOptics& optics)
        : camera_(optics.nominal),
          px_per_mm_(optics.pixel_scale / mm_per_px(optics.nominal)),
          rotation_rad_(optics.rotation_rad),
          nominal_(optics.pixel_scale == 1.0 && optics.rotation_rad == 0.0) {
        const double c = std::cos(rotation_rad_), s = std::sin(rotation_rad_);
        turn_ << c, -s, s, c;
    }

    /// Centre in the picture, px, of a plate point seen from camera position s.
    Eigen::Vector2d place(const Eigen::Vector2d& plate_mm, double s_mm) const {
        if (nominal_) return project(camera_, plate_mm, s_mm);
        return camera_.principal_point_px + displacement_px(plate_mm - Eigen::Vector2d(s_mm, 0.0));
    }
    /// A displacement on the plate, in the picture.
    Eigen::Vector2d displacement_px(const Eigen::Vector2d& step_mm) const {
        if (nominal_) return step_mm * px_per_mm_;
        return turn_ * step_mm * px_per_mm_;
    }
    double length_px(double length_mm) const { return length_mm * px_per_mm_; }
    /// The picture's shift in px, in the direction of plate x, when the camera moves by step_mm: a plate
    /// point moves the other way.
    double shift_px(double step_mm) const { return -step_mm * px_per_mm_; }
    /// Whether that direction is u.
    bool shifts_along_u() const { return rotation_rad_ == 0.0; }
    /// An angle from plate x towards y, as one from u towards v.
    double angle_rad(double plate_angle_rad) const { return plate_angle_rad + rotation_rad_; }

  private:
    CameraGeometry camera_;
    double px_per_mm_;
    double rotation_rad_;
    bool nominal_;
    Eigen::Matrix2d turn_;
};

}  // namespace fidservo::plant::view
