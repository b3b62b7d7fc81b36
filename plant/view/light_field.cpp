// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/light_field.h"

#include "core/random.h"

#include <cmath>

namespace fidservo::plant::view {

namespace {

/// -1 at the centre of the first pixel, 1 at that of the last.
double across(int pixel, int pixels) {
    return pixels > 1 ? 2.0 * pixel / (pixels - 1) - 1.0 : 0.0;
}

}  // namespace

std::vector<float> light_field(int width_px, int height_px, const ViewOptions& options) {
    NoiseStream gains(options.seed, "pixel_gain");
    std::vector<float> field;
    field.reserve(static_cast<std::size_t>(width_px) * height_px);
    for (int v = 0; v < height_px; ++v) {
        for (int u = 0; u < width_px; ++u) {
            const Eigen::Vector2d place(across(u, width_px), across(v, height_px));
            double gain = 1.0;
            if (options.pixel_gain_spread > 0.0) gain += options.pixel_gain_spread * gains.normal();
            field.push_back(static_cast<float>(255.0 * brightness(options.light, place) * gain));
        }
    }
    return field;
}

}  // namespace fidservo::plant::view
