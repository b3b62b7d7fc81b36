// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A plate, a camera above it, and images of it.
#include "core/plate.h"
#include "plant/view/view_options.h"
#include "vision/features/rest_image.h"

#include <cstdint>

namespace fidservo::vision::testing {

inline constexpr double ink = 0.1;

struct Scene {
    Plate plate;
    CameraParameters camera;
    double s_mm = 100.0;  ///< camera position
    plant::ViewOptions view;

    /// Adds a thing printed in ink.
    template <class Shape>
    void print(const Shape& shape, double reflectance = ink) {
        plate.features.push_back({"", shape, reflectance});
    }
};

/// The reference rig's camera with a sensor of another size, under that size's share of the rig's uneven
/// light.
Scene scene_of(int width_px, int height_px);

/// The image with the noise of the given seed, its position exactly known.
RestImage take(Scene scene, std::uint64_t seed);
/// The same without noise, rounded to 8 bits.
RestImage draw(Scene scene);

}  // namespace fidservo::vision::testing
