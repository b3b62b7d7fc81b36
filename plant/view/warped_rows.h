#pragma once
// Rows of reflectance of any camera: every pixel is painted for itself, at the place in the flat picture
// where it looks, and the motion during the exposure is a mean over places along the way. Slower than
// straight_rows.h, and the same where both are valid.
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
    struct Place {
        double s_mm;
        float weight;  ///< share of the exposure
    };
    void paint_at(double s_mm);

    const Picture& picture_;
    const PixelMap& pixels_;
    std::vector<Place> places_;
    std::vector<double> flat_u_, flat_v_;  ///< where the row's pixels look
    double low_v_ = 0.0, high_v_ = 0.0;
    std::vector<float> row_;
};

}  // namespace fidservo::plant::view
