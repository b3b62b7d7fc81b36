// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/line.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/vision_features/consistency.h"
#include "tests/vision_features/scene.h"

#include <cmath>

namespace fidservo::vision::testing {
namespace {

const Line nominal{{99.7, 0.0}, {100.3, 0.0}, 0.06};

Scene scene_with(const Line& line) {
    Scene scene = scene_of(200, 160);
    scene.print(line);
    return scene;
}

TEST(SlowMeasureLine, RandomPlacesWidthsAndAngles_ErrorsFollowTheStatedUncertainty) {
    constexpr std::uint64_t seed = 20281;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "lines");
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    Consistency width, offset, angle;
    double narrowest_bias_um = 0.0;
    for (int trial = 0; trial < 250; ++trial) {
        const bool upright = trial % 2 == 1;
        const double turn = (upright ? 1.5 : 0.0) + (trial % 3 == 0 ? 0.0 : between(-0.01, 0.01));
        const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
        const Eigen::Vector2d normal(-along.y(), along.x());
        const Eigen::Vector2d middle(100.0, 0.0);
        const double shift_mm = between(-0.03, 0.03);
        const Line line{middle - 0.35 * along + shift_mm * normal, middle + 0.35 * along + shift_mm * normal,
                        between(0.03, 0.1)};
        const Line expected{middle - 0.35 * along, middle + 0.35 * along, line.width_mm * between(0.9, 1.1)};
        const auto measured = measure_line(take(scene_with(line), seed + trial), expected);
        ASSERT_TRUE(measured) << measured.error().text;
        width.add(measured->width_um, 1000.0 * line.width_mm);
        offset.add(measured->offset_um, 1000.0 * shift_mm);
        angle.add(measured->angle_rad, turn);
        narrowest_bias_um += (measured->narrowest_um.value - 1000.0 * line.width_mm) / 250.0;
        EXPECT_NEAR(measured->narrowest_um.value, 1000.0 * line.width_mm, 5.0 * measured->narrowest_um.std);
    }
    expect_consistent(width, 0.004, "width");
    expect_consistent(offset, 0.003, "offset");
    expect_consistent(angle, 2e-5, "angle");
    EXPECT_NEAR(narrowest_bias_um, 0.0, 0.02);
}

TEST(MeasureLine, ThinNeck_IsSeenWhereItIs) {
    Scene scene = scene_with(nominal);
    scene.print(Pad{{100.1, 0.03}, {0.04, 0.03}}, scene.plate.paper_reflectance);  // cuts 15 um off one side
    const auto measured = measure_line(take(scene, 1), nominal);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->narrowest_um.value, 45.0, 0.5);
    EXPECT_NEAR(measured->narrowest_mm.x(), 100.1, 0.02);
    EXPECT_LT(measured->width_um.value, 60.0);
}

TEST(MeasureLine, Broken_HasAPlaceOfNoWidth) {
    Scene scene = scene_with(nominal);
    scene.print(Pad{{99.95, 0.0}, {0.06, 0.1}}, scene.plate.paper_reflectance);
    const auto measured = measure_line(take(scene, 1), nominal);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_LT(measured->narrowest_um.value, 5.0 * measured->narrowest_um.std);
    EXPECT_NEAR(measured->narrowest_mm.x(), 99.95, 0.04);
}

TEST(MeasureLine, ThinnerThanNominal_IsMeasured) {
    Line thin = nominal;
    thin.width_mm = 0.03;
    const auto measured = measure_line(take(scene_with(thin), 1), nominal);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->width_um.value, 30.0, 5.0 * measured->width_um.std);
}

TEST(MeasureLine, LeavingTheImage_IsMeasuredOnWhatIsSeen) {
    const Line longer{{99.0, 0.0}, {101.0, 0.0}, 0.06};
    const auto measured = measure_line(take(scene_with(longer), 1), longer);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->width_um.value, 60.0, 5.0 * measured->width_um.std);
    EXPECT_NEAR(measured->length_um, 750.0, 30.0);
}

TEST(MeasureLine, OutsideTheImage_IsNotIdentifiable) {
    const Line outside{{99.7, 0.5}, {100.3, 0.5}, 0.06};
    EXPECT_TRUE(fails_with(measure_line(take(scene_with(outside), 1), outside), Reason::not_identifiable));
}

TEST(MeasureLine, Missing_IsNotFound) {
    EXPECT_TRUE(fails_with(measure_line(take(scene_of(200, 160), 1), nominal), Reason::feature_not_found));
}

TEST(MeasureLine, UnderGlare_SaysSo) {
    Scene scene = scene_with(nominal);
    scene.view.glare.push_back({{100.0, 0.0}, 0.6, 3.0});
    EXPECT_TRUE(fails_with(measure_line(take(scene, 1), nominal), Reason::glare));
}

TEST(MeasureLine, CameraPositionsUncertainty_EntersAcrossTheLine) {
    RestImage image = take(scene_with(nominal), 1);
    const auto exact = measure_line(image, nominal);
    image.axis_std_mm = {0.0003, 0.0004};
    const auto measured = measure_line(image, nominal);
    ASSERT_TRUE(exact && measured);
    EXPECT_NEAR(measured->offset_um.std, std::hypot(0.4, exact->offset_um.std), 1e-9);
    EXPECT_EQ(measured->width_um.std, exact->width_um.std);
}

}  // namespace
}  // namespace fidservo::vision::testing
