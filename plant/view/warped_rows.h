// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rendering of image rows for any camera: every pixel is painted by itself, at the place in the flat picture
// that it sees, and the motion during the exposure is a mean over places along the path. Agrees with
// straight_rows.h where both are valid.
#include "plant/view/pixel_map.h"
#include "plant/view/straight_rows.h"

#include <span>
#include <vector>

namespace fidservo::plant::view {

class WarpedRows {
  public:
    WarpedRows(const Picture& picture, const PixelMap& pixels);

    /// Sets the camera's positions over the exposure of the rows that follow, evenly spaced, both ends
    /// included. They are refined to steps of half a pixel, up to 64 steps: a frame with more than 32 px of
    /// motion blur shows rows of faint copies, and no code in it can be read.
    void expose(std::span<const double> s_mm);
    /// Mean reflectance of a row's pixels.
    void paint(int v, std::span<float> mean);

  private:
    /// A thing with its place in the flat picture, and half the size of the box that it can reach.
    struct Placed {
        const Item* item;  ///< either the item or the glare is set
        const Glare* glare;
        Eigen::Vector2d centre_px, half_px;
    };
    struct Place {
        double growth;  ///< factor on all sizes
        float weight;   ///< fraction of the exposure
        std::vector<Placed> things;
    };
    void add_place(double s_mm, float weight);
    /// Pixels first .. last - 1 of the row that the thing can reach.
    PixelSpan pixels_of(const Placed& thing) const;
    static bool touches(const Placed& thing, PixelMap::Span rows);
    void paint_thing(const Placed& thing, double growth);
    void paint_at(const Place& place, PixelMap::Span rows);

    const Picture& picture_;
    const PixelMap& pixels_;
    std::vector<Place> places_;
    std::vector<double> flat_u_, flat_v_;  ///< the places that the row's pixels see
    std::vector<double> du_, dv_;          ///< the same, relative to a thing's centre
    std::vector<float> row_, coverage_;
};

}  // namespace fidservo::plant::view
