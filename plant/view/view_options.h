// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a rendered image depends on besides the camera's data sheet: light, noise and occluders.
#include "core/plate.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant {

/// The light on the plate, fixed to the camera. With x', y' from -1 to 1 across the image,
///     L = level (1 + gradient . (x', y')) (1 - vignetting (x'^2 + y'^2) / 2).
/// At L = 1 a perfect white just fills a pixel's well.
struct Light {
    double level = 1.0;  ///< signal of a perfect white, in full wells
    /// Relative change from the centre to the image's right and lower side.
    Eigen::Vector2d gradient = {0.08, -0.03};
    double vignetting = 0.06;  ///< relative loss in the corners
};

/// L at a place (x', y').
inline double brightness(const Light& light, const Eigen::Vector2d& place) {
    return light.level * (1.0 + light.gradient.dot(place)) *
           (1.0 - 0.5 * light.vignetting * place.squaredNorm());
}

/// A reflection of the lamp on the plate, which adds strength exp(-r^2 / (2 radius^2)) to the reflectance. A
/// strength above 1 saturates the middle.
struct Glare {
    static constexpr double reach_in_radii = 6.0;  ///< beyond this many radii it counts as 0
    Eigen::Vector2d centre_mm;                     ///< its place on the plate
    double radius_mm;                              ///< standard deviation
    double strength = 3.0;                         ///< added reflectance in the middle
};

/// What a rendered image depends on besides camera and plate.
struct ViewOptions {
    std::uint64_t seed = 1;          ///< seed of all noise
    bool noise = true;               ///< whether there is shot and read noise
    Light light;                     ///< on the plate
    double pixel_gain_spread = 0.0;  ///< standard deviation of the pixels' fixed gains around 1
    std::optional<double> blur_px;   ///< standard deviation of the blur, in place of the camera's
    std::vector<Feature> occluders;  ///< things that lie over everything printed
    std::vector<Glare> glare;        ///< reflections of the lamp
};

}  // namespace fidservo::plant
