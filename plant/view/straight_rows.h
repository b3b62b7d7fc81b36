// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rows of reflectance of a camera whose image is a similarity of the plate: things are painted row by row
// where they are, and the motion during the exposure, if there is any, is a convolution along u: it must be.
#include "plant/view/image_map.h"
#include "plant/view/motion_blur.h"
#include "plant/view/scene.h"
#include "plant/view/view_options.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// All that a picture is painted of.
struct Picture {
    int width, height;
    float paper;
    ImageMap map;
    std::vector<Item> items;
    std::vector<Glare> glare;
};

/// Whether a motion over the exposure is too small to be seen.
bool is_at_rest(const Picture& picture, std::span<const double> s_mm);

/// Pixels first .. last - 1 of a row.
struct PixelSpan {
    int first, last;

    bool contains(int pixel) const { return pixel >= first && pixel < last; }
};

class StraightRows {
  public:
    explicit StraightRows(const Picture& picture) : picture_(picture) {}

    /// For the rows that follow: the camera's positions over their exposure, evenly spaced, both ends
    /// included.
    void expose(std::span<const double> s_mm);
    /// Mean reflectance of a row's pixels.
    void paint(int v, std::span<float> mean);

  private:
    /// Something at its place, and the pixels it can reach.
    struct Placed {
        const Shape* shape;
        float reflectance;
        Eigen::Vector2d centre_px;
        PixelSpan across, down;
    };
    /// A reflection at its place: the product of a profile across and one down.
    struct PlacedGlare {
        PixelSpan across, down;
        std::vector<float> profile_across, profile_down;
    };

    void place_items(double s_mm);
    void place_glare(double s_mm);
    void paint(const Placed& item, int v);
    void add(const PlacedGlare& glare, int v);
    void average(std::span<float> mean) const;
    float* begin_writing(PixelSpan across);

    const Picture& picture_;
    MotionKernel motion_{std::vector<double>{0.0}};
    int margin_ = 0;  ///< pixels beyond both ends of the row, for what motion
                      ///< carries into the image
    std::vector<Placed> placed_;
    std::vector<PlacedGlare> glare_;
    PixelSpan painted_{};
    std::vector<float> row_, coverage_;
};

}  // namespace fidservo::plant::view
