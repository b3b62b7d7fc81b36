// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The warp from the flat picture (image_map.h) into the image, for a camera that is not a similarity of the
// plate.
#include "plant/view/image_map.h"

#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace fidservo::plant::view {

/// The place in the flat picture that each pixel sees. It is the same for every camera position, as the
/// camera moves along the plate. Coverages are evaluated at these places, so that every edge is where it is
/// seen, to the table's 1e-5 px. Only blur and pixel size are taken to be those of the flat picture
/// everywhere (at a tilt of 3 degrees an edge is up to 1.5 % wider than that, symmetrically about its place).
class PixelMap {
  public:
    PixelMap(const CameraGeometry& camera, const ImageMap& flat);

    /// Whether every pixel sees its own place.
    bool is_identity() const { return offset_u_px_.empty(); }

    /// The places that the pixels of row v see.
    void places(int v, std::span<double> flat_u_px, std::span<double> flat_v_px) const;

    /// The range of rows of the flat picture that image row v sees.
    struct Span {
        double low_px, high_px;
    };
    Span rows_of(int v) const;

    /// The bounding box, in the flat picture, of all places that the image sees.
    const Eigen::AlignedBox2d& view() const { return view_; }

  private:
    int width_;
    /// Offset of the place seen from the pixel, row by row; empty: no offsets.
    std::vector<float> offset_u_px_, offset_v_px_;
    std::vector<Span> rows_;
    Eigen::AlignedBox2d view_;
};

}  // namespace fidservo::plant::view
