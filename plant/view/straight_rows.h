// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rendering of image rows for a camera whose image is a similarity of the plate: things are painted row by
// row in place, and the motion during the exposure, if any, is a convolution along u. That requires that the
// camera moves along u.
#include "plant/view/image_map.h"
#include "plant/view/motion_blur.h"
#include "plant/view/scene.h"
#include "plant/view/view_options.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant::view {

/// Everything that an image is painted from.
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

    /// Sets the camera's positions over the exposure of the rows that follow, evenly spaced, both ends
    /// included.
    void expose(std::span<const double> s_mm);
    /// Mean reflectance of a row's pixels.
    void paint(int v, std::span<float> mean);

  private:
    /// A thing with its place, and the pixels that it can reach.
    struct Placed {
        const Shape* shape;
        float reflectance;
        Eigen::Vector2d centre_px;
        PixelSpan across, down;
    };
    /// A reflection of the lamp with its place: the product of a profile across and one down.
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
    int margin_ = 0;  ///< pixels beyond both ends of the row that motion may carry into the image
    std::vector<Placed> placed_;
    std::vector<PlacedGlare> glare_;
    PixelSpan painted_{};
    std::vector<float> row_, coverage_;
};

}  // namespace fidservo::plant::view
