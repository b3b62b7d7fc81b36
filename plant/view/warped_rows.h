// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rows of reflectance of any camera: every pixel is painted for itself, at the place in the flat picture
// where it looks, and the motion during the exposure is a mean over places along the way. The same as
// straight_rows.h where both are valid.
#include "plant/view/pixel_map.h"
#include "plant/view/straight_rows.h"

#include <span>
#include <vector>

namespace fidservo::plant::view {

class WarpedRows {
  public:
    WarpedRows(const Picture& picture, const PixelMap& pixels);

    /// For the rows that follow: the camera's positions over their exposure, evenly spaced, both ends
    /// included. They are refined to steps of half a pixel, up to 64 of them: a frame that is smeared over
    /// more than 32 px shows rows of faint copies, in which nothing can be read as it is.
    void expose(std::span<const double> s_mm);
    /// Mean reflectance of a row's pixels.
    void paint(int v, std::span<float> mean);

  private:
    /// Something at its place in the flat picture, and half the size of the box that it can reach.
    struct Placed {
        const Item* item;  ///< or none,
        const Glare* glare;
        Eigen::Vector2d centre_px, half_px;
    };
    struct Place {
        double growth;  ///< of all sizes
        float weight;   ///< share of the exposure
        std::vector<Placed> things;
    };
    void add_place(double s_mm, float weight);
    /// Pixels first .. last - 1 of the row that can see it.
    PixelSpan pixels_of(const Placed& thing) const;
    static bool touches(const Placed& thing, PixelMap::Span rows);
    void paint_thing(const Placed& thing, double growth);
    void paint_at(const Place& place, PixelMap::Span rows);

    const Picture& picture_;
    const PixelMap& pixels_;
    std::vector<Place> places_;
    std::vector<double> flat_u_, flat_v_;  ///< where the row's pixels look
    std::vector<double> du_, dv_;          ///< the same, from a thing's centre
    std::vector<float> row_, coverage_;
};

}  // namespace fidservo::plant::view
