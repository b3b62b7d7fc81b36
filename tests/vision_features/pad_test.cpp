// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/pad.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/vision_features/consistency.h"
#include "tests/vision_features/scene.h"

#include <cmath>

namespace fidservo::vision::testing {
namespace {

const Pad nominal{{100.0, 0.0}, {0.3, 0.2}};

Scene scene_with(const Pad& pad) {
    Scene scene = scene_of(200, 160);
    scene.print(pad);
    return scene;
}

TEST(SlowMeasurePad, RandomPlacesSizesAndAngles_ErrorsFollowTheStatedUncertainty) {
    constexpr std::uint64_t seed = 20271;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "pads");
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    Consistency x, y, width, height, angle;
    for (int trial = 0; trial < 250; ++trial) {
        const bool square_on = trial % 3 == 0;
        const Pad pad{{100.0 + between(-0.04, 0.04), between(-0.04, 0.04)},
                      {between(0.2, 0.35), between(0.12, 0.25)},
                      square_on ? 0.0 : between(-0.02, 0.02)};
        const auto measured = measure_pad(take(scene_with(pad), seed + trial), {{100.0, 0.0}, pad.size_mm});
        ASSERT_TRUE(measured) << measured.error().text;
        x.add(measured->x_um, 1000.0 * pad.centre_mm.x());
        y.add(measured->y_um, 1000.0 * pad.centre_mm.y());
        width.add(measured->width_um, 1000.0 * pad.size_mm.x());
        height.add(measured->height_um, 1000.0 * pad.size_mm.y());
        angle.add(measured->angle_rad, pad.angle_rad);
    }
    expect_consistent(x, 0.006, "x");
    expect_consistent(y, 0.006, "y");
    expect_consistent(width, 0.008, "width");
    expect_consistent(height, 0.008, "height");
    expect_consistent(angle, 5e-5, "angle");
}

TEST(MeasurePad, TurnedByHalfARadian_IsMeasuredAlongItsOwnAxes) {
    const Pad turned{{100.0, 0.0}, {0.3, 0.2}, 0.5};
    const auto measured = measure_pad(take(scene_with(turned), 1), turned);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->width_um.value, 300.0, 5.0 * measured->width_um.std);
    EXPECT_NEAR(measured->height_um.value, 200.0, 5.0 * measured->height_um.std);
    EXPECT_NEAR(measured->angle_rad.value, 0.5, 5.0 * measured->angle_rad.std);
}

TEST(MeasurePad, ShiftedByTwentyMicrometres_ReadsTwentyMicrometres) {
    const Pad shifted{{100.02, 0.0}, {0.3, 0.2}};
    const auto measured = measure_pad(take(scene_with(shifted), 1), nominal);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->x_um.value - 100000.0, 20.0, 5.0 * measured->x_um.std);
}

TEST(MeasurePad, Missing_IsNotFound) {
    EXPECT_TRUE(fails_with(measure_pad(take(scene_of(200, 160), 1), nominal), Reason::feature_not_found));
}

TEST(MeasurePad, PartlyOutsideTheImage_IsNotIdentifiable) {
    const Pad cut{{100.3, 0.0}, {0.3, 0.2}};
    EXPECT_TRUE(fails_with(measure_pad(take(scene_with(cut), 1), cut), Reason::not_identifiable));
}

TEST(MeasurePad, ADotInItsPlace_IsNotAPad) {
    Scene scene = scene_of(200, 160);
    scene.print(Dot{{100.0, 0.0}, 0.28});
    EXPECT_FALSE(measure_pad(take(scene, 1), nominal));
}

TEST(MeasurePad, HalfHidden_IsOccluded) {
    Scene scene = scene_with(nominal);
    scene.view.occluders.push_back({"dirt", Dot{{100.1, 0.05}, 0.3}, 0.6});
    const auto measured = measure_pad(take(scene, 1), nominal);
    EXPECT_TRUE(fails_with(measured, Reason::occluded));
}

TEST(MeasurePad, ScratchAcross_NeverAWrongValueWithoutItsUncertainty) {
    constexpr std::uint64_t seed = 20272;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "scratches");
    int measured_count = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const auto point = [&] {
            return Eigen::Vector2d(99.75 + 0.5 * random.uniform(), -0.2 + 0.4 * random.uniform());
        };
        Scene scene = scene_with(nominal);
        scene.view.occluders.push_back({"scratch", Scratch{{point(), point()}, 0.015}, random.uniform()});
        const auto measured = measure_pad(take(scene, seed + trial), nominal);
        if (!measured) continue;
        ++measured_count;
        EXPECT_NEAR(measured->x_um.value, 100000.0, 5.0 * measured->x_um.std) << "trial " << trial;
        EXPECT_NEAR(measured->y_um.value, 0.0, 5.0 * measured->y_um.std) << "trial " << trial;
        EXPECT_NEAR(measured->width_um.value, 300.0, 5.0 * measured->width_um.std) << "trial " << trial;
        EXPECT_NEAR(measured->height_um.value, 200.0, 5.0 * measured->height_um.std) << "trial " << trial;
    }
    EXPECT_GT(measured_count, 50);
}

}  // namespace
}  // namespace fidservo::vision::testing
