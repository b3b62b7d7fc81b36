#pragma once
// Where the plate's things are in the image, for the painters: the one place that knows the camera's
// geometry.
#include "core/camera_geometry.h"

#include <Eigen/Core>

namespace fidservo::plant::view {

/// The local map from plate to image around a point: scale and rotation there. The reference camera looks
/// straight down, so both are the same everywhere and at every camera position; a tilted or distorting camera
/// would linearise its map here.
class ImageMap {
  public:
    explicit ImageMap(const CameraGeometry& camera) : camera_(camera) {}

    /// Centre in the image, px, of a plate point seen from camera position s.
    Eigen::Vector2d place(const Eigen::Vector2d& plate_mm, double s_mm) const {
        return project(camera_, plate_mm, s_mm);
    }
    /// A small displacement on the plate, in the image.
    Eigen::Vector2d displacement_px(const Eigen::Vector2d& step_mm) const { return step_mm * px_per_mm(); }
    double length_px(double length_mm) const { return length_mm * px_per_mm(); }
    /// The image's shift in u, px, when the camera moves by step_mm: a plate point moves the other way.
    double shift_px(double step_mm) const { return -step_mm * px_per_mm(); }
    /// An angle from plate x towards y, as one from u towards v.
    static double angle_rad(double plate_angle_rad) { return plate_angle_rad; }

  private:
    double px_per_mm() const { return 1.0 / mm_per_px(camera_); }

    CameraGeometry camera_;
};

}  // namespace fidservo::plant::view
