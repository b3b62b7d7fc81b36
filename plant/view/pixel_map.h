#pragma once
// What a tilted or distorting camera does to the flat picture (image_map.h).
#include "plant/camera.h"
#include "plant/view/image_map.h"

#include <vector>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// Where in the flat picture each pixel looks. The same for every camera position, as the camera moves along
/// the plate. The painters evaluate their coverage there, so that every edge is where it is seen, to the
/// table's 1e-5 px; only blur and pixel are taken to have the flat picture's size in all of the image (a tilt
/// of 3 degrees makes an edge up to 1.5 % wider than that, symmetrically about its place).
class PixelMap {
  public:
    PixelMap(const CameraOptics& optics, const ImageMap& flat);

    /// Without tilt and distortion every pixel looks at its own place.
    bool is_identity() const { return offsets_px_.empty(); }

    Eigen::Vector2d flat_px(int u, int v) const {
        const Eigen::Vector2d pixel(u, v);
        if (is_identity()) return pixel;
        return pixel + offsets_px_[static_cast<std::size_t>(v) * width_ + u].cast<double>();
    }

  private:
    int width_;
    std::vector<Eigen::Vector2f> offsets_px_;  ///< row by row; empty: none
};

}  // namespace fidservo::plant::view
