// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/mark.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/vision_features/consistency.h"
#include "tests/vision_features/scene.h"

#include <cmath>
#include <numbers>

namespace fidservo::vision::testing {
namespace {

const Dot nominal{{100.0, 0.0}, 0.25};

Scene scene_with(const Dot& dot) {
    Scene scene = scene_of(200, 200);
    scene.print(dot);
    return scene;
}

TEST(SlowMeasureDot, RandomPlacesAndSizes_ErrorsFollowTheStatedUncertainty) {
    constexpr std::uint64_t seed = 20261;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "dots");
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    Consistency x, y, diameter;
    for (int trial = 0; trial < 250; ++trial) {
        const Dot dot{{100.0 + between(-0.04, 0.04), between(-0.04, 0.04)}, between(0.1, 0.4)};
        Scene scene = scene_with(dot);
        scene.s_mm += between(-0.02, 0.02);
        const auto measured =
            measure_dot(take(scene, seed + trial), {{100.0, 0.0}, dot.diameter_mm * between(0.9, 1.1)});
        ASSERT_TRUE(measured) << measured.error().text;
        x.add(measured->x_um, 1000.0 * dot.centre_mm.x());
        y.add(measured->y_um, 1000.0 * dot.centre_mm.y());
        diameter.add(measured->diameter_um, 1000.0 * dot.diameter_mm);
    }
    expect_consistent(x, 0.005, "x");
    expect_consistent(y, 0.005, "y");
    expect_consistent(diameter, 0.005, "diameter");
}

TEST(MeasureDot, CameraPositionsUncertainty_EntersThePlaceAndNotTheSize) {
    RestImage image = take(scene_with(nominal), 1);
    const auto exact = measure_dot(image, nominal);
    image.axis_std_mm = {0.0003, 0.0004};
    const auto measured = measure_dot(image, nominal);
    ASSERT_TRUE(exact && measured);
    EXPECT_NEAR(measured->x_um.std, std::hypot(0.3, exact->x_um.std), 1e-12);
    EXPECT_NEAR(measured->y_um.std, std::hypot(0.4, exact->y_um.std), 1e-12);
    EXPECT_EQ(measured->diameter_um.std, exact->diameter_um.std);
}

TEST(MeasureDot, BlurOtherThanTheDataSheets_IsFoundAndDoesNotBias) {
    for (const double blur_px : {0.6, 1.1}) {
        Scene scene = scene_with(nominal);
        scene.view.blur_px = blur_px;
        const auto measured = measure_dot(take(scene, 3), nominal);
        ASSERT_TRUE(measured) << measured.error().text;
        EXPECT_NEAR(measured->quality.blur_px, blur_px, 0.05);
        EXPECT_NEAR(measured->diameter_um.value, 250.0, 5.0 * measured->diameter_um.std);
    }
}

TEST(MeasureDot, NothingPrinted_IsNotFound) {
    EXPECT_TRUE(fails_with(measure_dot(take(scene_of(200, 200), 1), nominal), Reason::feature_not_found));
}

TEST(MeasureDot, TooFaint_IsNotFoundAndSaysWhatWasFound) {
    Scene scene = scene_of(200, 200);
    scene.print(nominal, 0.75);
    const auto result = measure_dot(take(scene, 1), nominal);
    ASSERT_TRUE(fails_with(result, Reason::feature_not_found));
    EXPECT_NE(result.error().text.find("contrast 0.17 found, 0.89 expected"), std::string::npos)
        << result.error().text;
}

TEST(MeasureDot, BeyondTheMargin_IsNotFound) {
    const Dot far{{100.15, 0.0}, 0.25};
    EXPECT_TRUE(fails_with(measure_dot(take(scene_with(far), 1), nominal), Reason::feature_not_found));
}

TEST(MeasureDot, BrighterThanItsSurroundings_IsMeasuredToo) {
    Scene scene = scene_of(200, 200);
    scene.plate.paper_reflectance = 0.3;
    scene.print(nominal, 0.9);
    SearchOptions options;
    options.expected_contrast = 1.0 - 0.9 / 0.3;
    const auto measured = measure_dot(take(scene, 1), nominal, options);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->diameter_um.value, 250.0, 5.0 * measured->diameter_um.std);
}

TEST(MeasureDot, PartlyOutsideTheImage_IsNotIdentifiable) {
    const Dot cut{{100.3, 0.0}, 0.25};
    EXPECT_TRUE(fails_with(measure_dot(take(scene_with(cut), 1), cut), Reason::not_identifiable));
}

TEST(MeasureDot, TwoCandidatesWithinTheMargin_AreNotIdentifiable) {
    Scene scene = scene_of(200, 200);
    scene.print(Dot{{99.94, 0.0}, 0.1});
    scene.print(Dot{{100.06, 0.0}, 0.1});
    SearchOptions options;
    options.margin_mm = 0.08;
    EXPECT_TRUE(
        fails_with(measure_dot(take(scene, 1), {{100.0, 0.0}, 0.1}, options), Reason::not_identifiable));
}

TEST(MeasureDot, NeighbourInTheSearchRegion_DoesNotBias) {
    Scene scene = scene_with(nominal);
    scene.print(Pad{{100.19, 0.0}, {0.1, 0.3}});
    const auto measured = measure_dot(take(scene, 1), nominal);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->x_um.value, 100000.0, 5.0 * measured->x_um.std);
    EXPECT_NEAR(measured->diameter_um.value, 250.0, 5.0 * measured->diameter_um.std);
}

TEST(MeasureDot, HalfHidden_IsOccluded) {
    Scene scene = scene_with(nominal);
    scene.view.occluders.push_back({"dirt", Pad{{100.1, 0.0}, {0.2, 0.4}}, 0.5});
    EXPECT_TRUE(fails_with(measure_dot(take(scene, 1), nominal), Reason::occluded));
}

TEST(MeasureDot, UnderGlare_SaysSo) {
    Scene scene = scene_with(nominal);
    scene.view.glare.push_back({{100.0, 0.0}, 0.5, 3.0});
    EXPECT_TRUE(fails_with(measure_dot(take(scene, 1), nominal), Reason::glare));
}

TEST(MeasureDot, PaperJustBelowWhite_DoesNotBias) {
    Scene scene = scene_with(nominal);
    scene.view.light = {1.1, {0.0, 0.0}, 0.0};  // 252 of 255 grey levels: one pixel in eight is clipped
    const auto measured = measure_dot(take(scene, 1), nominal);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->diameter_um.value, 250.0, 5.0 * measured->diameter_um.std);
}

TEST(MeasureDot, DirtOnItsEdge_NeverAWrongValueWithoutItsUncertainty) {
    constexpr std::uint64_t seed = 20262;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "dirt");
    int measured_count = 0;
    for (int trial = 0; trial < 150; ++trial) {
        const double angle = 2.0 * std::numbers::pi * random.uniform();
        const double distance = 0.09 + 0.09 * random.uniform();
        const Dot dirt{nominal.centre_mm + distance * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                       0.02 + 0.1 * random.uniform()};
        Scene scene = scene_with(nominal);
        scene.view.occluders.push_back({"dirt", dirt, random.uniform()});
        const auto measured = measure_dot(take(scene, seed + trial), nominal);
        if (!measured) continue;
        ++measured_count;
        EXPECT_NEAR(measured->x_um.value, 100000.0, 5.0 * measured->x_um.std) << "trial " << trial;
        EXPECT_NEAR(measured->y_um.value, 0.0, 5.0 * measured->y_um.std) << "trial " << trial;
        EXPECT_NEAR(measured->diameter_um.value, 250.0, 5.0 * measured->diameter_um.std) << "trial " << trial;
    }
    EXPECT_GT(measured_count, 75);
}

}  // namespace
}  // namespace fidservo::vision::testing
