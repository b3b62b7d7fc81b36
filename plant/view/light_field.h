// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The grey level of a perfect white at each pixel.
#include "plant/view/view_options.h"

#include <vector>

namespace fidservo::plant::view {

/// Grey level of reflectance 1 at each pixel, row by row: 255 times the light, times the pixel's fixed gain,
/// which is drawn from the stream "pixel_gain" of the options' seed.
std::vector<float> light_field(int width_px, int height_px, const ViewOptions& options);

}  // namespace fidservo::plant::view
