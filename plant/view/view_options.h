// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the plate's picture depends on beside the camera's data sheet.
#include "core/plate.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant {

/// The light on the plate, fixed to the camera. With x', y' from -1 to 1 across the image,
///     L = level (1 + gradient . (x', y')) (1 - vignetting (x'^2 + y'^2) / 2).
/// At L = 1 a perfect white just fills the well.
struct Light {
    double level = 1.0;                        ///< of a perfect white, in full wells
    Eigen::Vector2d gradient = {0.08, -0.03};  ///< relative change across half the image
    double vignetting = 0.06;                  ///< loss in the corners
};

/// L at (x', y').
inline double brightness(const Light& light, const Eigen::Vector2d& place) {
    return light.level * (1.0 + light.gradient.dot(place)) *
           (1.0 - 0.5 * light.vignetting * place.squaredNorm());
}

/// A reflection of the lamp on the plate: reflectance gains strength exp(-r^2 / (2 radius^2)). A strength
/// above 1 saturates the middle.
struct Glare {
    static constexpr double reach_in_radii = 6.0;  ///< nothing is left of it beyond
    Eigen::Vector2d centre_mm;                     ///< on the plate
    double radius_mm;                              ///< standard deviation
    double strength = 3.0;                         ///< reflectance gained in the middle
};

/// What the picture depends on beside camera and plate.
struct ViewOptions {
    std::uint64_t seed = 1;          ///< of all noise
    bool noise = true;               ///< shot and read noise
    Light light;                     ///< on the plate
    double pixel_gain_spread = 0.0;  ///< standard deviation of the pixels' fixed gains around 1
    std::optional<double> blur_px;   ///< in place of the camera's
    std::vector<Feature> occluders;  ///< whatever lies on the plate, over everything printed
    std::vector<Glare> glare;        ///< reflections of the lamp
};

}  // namespace fidservo::plant
