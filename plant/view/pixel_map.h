// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a camera that is not a similarity of the plate does to the flat picture (image_map.h).
#include "plant/view/image_map.h"

#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace fidservo::plant::view {

/// Where in the flat picture each pixel looks. The same for every camera position, as the camera moves along
/// the plate. The painters evaluate their coverage there, so that every edge is where it is seen, to the
/// table's 1e-5 px; only blur and pixel are taken to have the flat picture's size in all of the image (a tilt
/// of 3 degrees makes an edge up to 1.5 % wider than that, symmetrically about its place).
class PixelMap {
  public:
    PixelMap(const CameraGeometry& camera, const ImageMap& flat);

    /// Every pixel looks at its own place.
    bool is_identity() const { return offset_u_px_.empty(); }

    /// Where the pixels of row v look.
    void places(int v, std::span<double> flat_u_px, std::span<double> flat_v_px) const;

    /// All that row v looks at lies within.
    struct Span {
        double low_px, high_px;
    };
    Span rows_of(int v) const;

    /// All that the image looks at lies within.
    const Eigen::AlignedBox2d& view() const { return view_; }

  private:
    int width_;
    std::vector<float> offset_u_px_, offset_v_px_;  ///< row by row; empty: none
    std::vector<Span> rows_;
    Eigen::AlignedBox2d view_;
};

}  // namespace fidservo::plant::view
