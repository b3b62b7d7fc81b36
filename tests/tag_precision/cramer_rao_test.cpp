// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/cramer_rao.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::precision {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

double bound_u_px(const TagScene& scene, const Sensor& sensor = {}) {
    return std::sqrt(position_bound(scene, sensor)(0, 0));
}

/// Bounds that somebody else computed with other code, for edges of 1.0 px and grey levels 33 and 194 of 255.
TEST(CramerRao, PublishedConditions_GiveThePublishedBounds) {
    TagScene sharp;
    sharp.tag_id = 20;
    sharp.angle_rad = 0.7 * degree;
    sharp.blur.sigma_px = 1.0;
    sharp.black = 0.13;
    sharp.white = 0.76;
    const auto with = [&](const std::function<void(TagScene&)>& change) {
        TagScene scene = sharp;
        change(scene);
        return scene;
    };
    constexpr double two_per_cent = 0.02;
    const auto expect = [&](double bound_px, double published_px) {
        EXPECT_NEAR(bound_px / published_px, 1.0, two_per_cent) << published_px;
    };
    expect(bound_u_px(sharp), 0.49e-3);
    expect(bound_u_px(with([](TagScene& s) { s.blur.sigma_px = 3.0; })), 0.85e-3);
    expect(bound_u_px(sharp, {.full_well_e = 1000.0}), 1.58e-3);  // a tenth of the light, ten times the gain
    expect(bound_u_px(with([](TagScene& s) { s.camera.tilt_rad.y() = 5 * degree; })), 0.49e-3);
    expect(bound_u_px(with([](TagScene& s) { s.side_px = 60.0; })), 1.17e-3);
    expect(bound_u_px(with([](TagScene& s) { s.blur.motion_px = 5.0; })), 0.64e-3);
    expect(bound_u_px(with([](TagScene& s) { s.angle_rad = 0.0; })), 0.49e-3);
}

TEST(CramerRao, UnknownTilt_CostsTwoFifths) {
    TagScene scene;
    scene.tag_id = 20;
    scene.angle_rad = 0.7 * degree;
    const double known = std::sqrt(position_bound(scene, {})(0, 0));
    const double unknown = std::sqrt(position_bound(scene, {}, {true})(0, 0));
    EXPECT_NEAR(unknown / known, 1.42, 0.03);
}

/// Without read noise, and with little rounding, information is proportional to light.
TEST(CramerRao, LightHundredfold_MakesItTenTimesAsPrecise) {
    const TagScene scene;
    const double some = bound_u_px(scene, {.full_well_e = 10.0, .read_noise_e = 0.0});
    const double more = bound_u_px(scene, {.full_well_e = 1000.0, .read_noise_e = 0.0});
    EXPECT_NEAR(some / more, 10.0, 0.1);
}

TEST(CramerRao, HiddenHalf_LeavesLessThanHalfOfTheInformation) {
    TagScene scene;
    scene.side_px = 200.0;
    const double whole = bound_u_px(scene);
    scene.cover = Cover{{{-0.6, 0.0}, {0.6, 0.0}, {0.6, 0.6}, {-0.6, 0.6}}, 0.4};
    EXPECT_GT(bound_u_px(scene) / whole, std::numbers::sqrt2 * 0.98);
    EXPECT_LT(bound_u_px(scene) / whole, 4.0);
}

}  // namespace
}  // namespace fidservo::precision
