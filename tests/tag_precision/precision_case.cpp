// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/precision_case.h"

#include "tests/tag_precision/cramer_rao.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace fidservo::precision {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double no_limit = std::numeric_limits<double>::infinity();

constexpr PrecisionLimits in_good_order{1.1, 0.001, 0.0003};
constexpr PrecisionLimits robust{1.5, 0.002, no_limit};
constexpr PrecisionLimits damaged{1.5, 0.005, no_limit};

vision::GreyNoise noise_of(const Sensor& sensor) {
    const double grey_per_e = vision::white_grey / sensor.full_well_e;
    return {grey_per_e, std::pow(grey_per_e * sensor.read_noise_e, 2) + 1.0 / 12.0, sensor.gain_spread};
}

PrecisionCase sharp() {
    PrecisionCase it;
    it.name = "sharp";
    it.scene.tag_id = 20;
    it.scene.angle_rad = 0.7 * degree;
    it.scene.black = 0.13;
    it.scene.white = 0.76;
    it.limits = in_good_order;
    return it;
}

/// Changes made, then told to the refinement as far as a camera's owner knows them.
PrecisionCase variant(const std::string& name, const PrecisionLimits& limits,
                      const std::function<void(PrecisionCase&)>& change) {
    PrecisionCase it = sharp();
    it.name = name;
    it.limits = limits;
    change(it);
    it.known.camera = it.scene.camera;
    it.known.noise = noise_of(it.sensor);
    it.known.motion_px = {it.scene.blur.motion_px, 0.0};
    return it;
}

/// A sheet across one corner that hides a fifth of the tag.
Cover sheet() {
    const double leg = std::sqrt(2.0 * 0.2), beyond = 0.15;
    return {{{0.5 - leg - beyond, -0.5 - beyond},
             {0.5 + beyond, -0.5 - beyond},
             {0.5 + beyond, -0.5 + leg + beyond}},
            0.4};
}

/// 3 px wide, from one side to the other at 20 degrees.
Cover scratch(double side_px, double level) {
    const Eigen::Vector2d from(-0.6, -0.2), to(0.6, 0.237), along = (to - from).normalized();
    const Eigen::Vector2d half_width = 1.5 / side_px * Eigen::Vector2d(-along.y(), along.x());
    return {{from - half_width, to - half_width, to + half_width, from + half_width}, level};
}

}  // namespace

Eigen::Matrix2d PrecisionCase::bound_px2() const {
    return position_bound(scene, sensor, {!known.camera.has_value()});
}

std::vector<PrecisionCase> precision_cases() {
    using Case = PrecisionCase;
    std::vector<PrecisionCase> cases{
        variant("sharp", in_good_order, [](Case&) {}),
        variant("defocus 3 px", in_good_order, [](Case& c) { c.scene.blur.sigma_px = 3.0; }),
        variant("a tenth of the light", in_good_order, [](Case& c) { c.sensor.full_well_e = 1000.0; }),
        variant("tilt 5 deg", in_good_order, [](Case& c) { c.scene.camera.tilt_rad.y() = 5.0 * degree; }),
        variant("60 px tag", in_good_order, [](Case& c) { c.scene.side_px = 60.0; }),
        variant("motion 5 px", in_good_order, [](Case& c) { c.scene.blur.motion_px = 5.0; }),
        variant("along the pixels", in_good_order, [](Case& c) { c.scene.angle_rad = 0.0; }),
        variant("gain spread 1 %", in_good_order, [](Case& c) { c.sensor.gain_spread = 0.01; }),
        variant("camera unknown", in_good_order, [](Case&) {}),
        variant("ink spread 0.3 px", robust, [](Case& c) { c.scene.ink_spread_px = 0.3; }),
        variant("gamma 2.2", robust,
                [](Case& c) {
                    c.sensor.gamma = 2.2;
                    c.sensor.noise_after_gamma = true;
                }),
        variant("gamma 2.2, noise too", robust, [](Case& c) { c.sensor.gamma = 2.2; }),
        variant("edges 20 % wider", robust, [](Case& c) { c.scene.blur.sigma_px = 0.96; }),
        variant("edges with a halo", robust,
                [](Case& c) { c.scene.blur = {.sigma_px = 0.7, .halo_share = 0.3, .halo_sigma_px = 1.389}; }),
        variant("uneven light", robust,
                [](Case& c) {
                    c.scene.illumination = {.gradient = {0.1, -0.1}, .vignetting = -0.1};
                }),
        variant("a fifth hidden", damaged, [](Case& c) { c.scene.cover = sheet(); }),
        variant("bright scratch", damaged, [](Case& c) { c.scene.cover = scratch(c.scene.side_px, 0.9); }),
        variant("dark scratch", damaged, [](Case& c) { c.scene.cover = scratch(c.scene.side_px, 0.1); }),
        variant("glare on a corner", damaged,
                [](Case& c) {
                    c.scene.glare = Glare{{0.5, -0.5}, 20.0, 3.0};
                }),
    };
    for (PrecisionCase& it : cases) {
        if (it.name == "camera unknown") it.known.camera.reset();
        // The square root, and nearly so this gamma, makes shot noise the same at all grey levels.
        if (it.name == "gamma 2.2, noise too") it.known.noise = {0.0, grey_variance(it.sensor, 0.4), 0.0};
    }
    return cases;
}

}  // namespace fidservo::precision
