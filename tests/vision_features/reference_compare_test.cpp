// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/reference_compare.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/effort.h"
#include "tests/vision_features/consistency.h"
#include "tests/vision_features/scene.h"

#include <cmath>

namespace fidservo::vision::testing {
namespace {

/// A tag, dots, pads and lines in a view of 640 x 480 px (2.56 x 1.92 mm) around x = 100 mm.
Scene good_scene() {
    Scene scene = scene_of(640, 480);
    scene.plate.tags.push_back({50, {100.0, 0.0}, 1.0});
    for (int k = 0; k < 4; ++k) {
        scene.print(Dot{{99.1 + 0.6 * k, -0.75}, 0.1 + 0.08 * k});
        scene.print(Pad{{99.1 + 0.6 * k, 0.75}, {0.3, 0.2}});
    }
    scene.print(Line{{99.05, -0.3}, {99.05, 0.4}, 0.06});
    scene.print(Line{{100.9, -0.3}, {100.9, 0.4}, 0.04});
    return scene;
}

ReferenceImage noisy_reference() {
    const RestImage good = take(good_scene(), 4711);
    return {good.grey, good.axis_mm, false};
}

ReferenceImage drawn_reference() {
    Scene scene = good_scene();
    scene.view.light = {1.0, {0.0, 0.0}, 0.0};
    const RestImage ideal = draw(scene);
    return {ideal.grey, ideal.axis_mm, true};
}

/// The defects of a scene against a drawn reference.
std::vector<Defect> defects_of(const Scene& scene, std::uint64_t seed = 1) {
    const auto comparison = compare_with_reference(take(scene, seed), drawn_reference());
    EXPECT_TRUE(comparison) << comparison.error().text;
    return comparison ? comparison->defects : std::vector<Defect>{};
}

void expect_no_defects_in_good_views(const ReferenceImage& reference, std::uint64_t seed) {
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "views");
    const auto within = [&](double half) { return half * (2.0 * random.uniform() - 1.0); };
    for (int view = 0; view < fidservo::testing::draws(200, 40); ++view) {
        Scene scene = good_scene();
        scene.s_mm += within(0.05);
        scene.view.light.gradient = {within(0.06), within(0.06)};
        RestImage image = take(scene, seed + view);
        image.axis_mm.x() += within(0.001);
        const auto comparison = compare_with_reference(image, reference);
        ASSERT_TRUE(comparison) << comparison.error().text;
        EXPECT_TRUE(comparison->defects.empty())
            << "view " << view << ": significance " << comparison->defects[0].significance;
    }
}

TEST(SlowCompareWithReference, ManyGoodViewsAgainstANoisyReference_NoDefects) {
    expect_no_defects_in_good_views(noisy_reference(), 20301);
}

TEST(SlowCompareWithReference, ManyGoodViewsAgainstADrawnReference_NoDefects) {
    expect_no_defects_in_good_views(drawn_reference(), 20302);
}

TEST(CompareWithReference, UnknownPartOfTheShift_IsFound) {
    Scene scene = good_scene();
    scene.s_mm += 0.0131;
    RestImage image = take(scene, 1);
    image.axis_mm.x() -= 0.010;  // 2.5 px beyond the measured position
    const auto comparison = compare_with_reference(image, noisy_reference());
    ASSERT_TRUE(comparison) << comparison.error().text;
    EXPECT_NEAR(comparison->misregistration_px.x(), 2.5, 0.02);
    EXPECT_NEAR(comparison->misregistration_px.y(), 0.0, 0.02);
    EXPECT_TRUE(comparison->defects.empty());
}

TEST(CompareWithReference, MissingDot_IsOneDefectOfItsSizeAndPlace) {
    Scene scene = good_scene();
    std::erase_if(scene.plate.features, [](const Feature& feature) {
        const auto* dot = std::get_if<Dot>(&feature.shape);
        return dot != nullptr && std::abs(dot->diameter_mm - 0.18) < 1e-9;
    });
    const auto defects = defects_of(scene);
    ASSERT_EQ(defects.size(), 1u);
    EXPECT_EQ(defects[0].sign, DefectSign::missing_ink);
    EXPECT_NEAR(defects[0].centre_mm.x(), 99.7, 0.001);
    EXPECT_NEAR(defects[0].centre_mm.y(), -0.75, 0.001);
    EXPECT_NEAR(defects[0].equivalent_diameter_um, 180.0, 4.0);
    EXPECT_NEAR(defects[0].length_um, 180.0, 8.0);
}

TEST(CompareWithReference, ShiftedPad_IsMissingOnOneSideAndAdditionalOnTheOther) {
    Scene scene = good_scene();
    std::get<Pad>(scene.plate.features[1].shape).centre_mm.x() += 0.012;
    const auto defects = defects_of(scene);
    ASSERT_EQ(defects.size(), 2u);
    EXPECT_NE(defects[0].sign, defects[1].sign);
    EXPECT_NEAR(defects[0].length_um, 200.0, 12.0);
    EXPECT_NEAR(std::abs(defects[0].centre_mm.x() - defects[1].centre_mm.x()), 0.3, 0.002);
}

TEST(CompareWithReference, ScratchesTenToTwentyMicrometresWide_AreFoundOnPaperAndAcrossFeatures) {
    for (const double width_mm : {0.010, 0.015, 0.020}) {
        Scene scene = good_scene();
        scene.print(Scratch{{{99.0, 0.55}, {99.3, 0.95}}, width_mm}, 0.5);
        scene.print(Scratch{{{100.7, -0.5}, {100.85, -0.3}}, width_mm}, 0.6);
        const auto defects = defects_of(scene);
        ASSERT_EQ(defects.size(), 2u) << width_mm;
        EXPECT_NEAR(defects[0].centre_mm.x(), 99.15, 0.1);
        EXPECT_NEAR(defects[0].length_um, 500.0, 40.0);
        EXPECT_NEAR(defects[1].centre_mm.x(), 100.775, 0.01);
        EXPECT_NEAR(defects[1].length_um, 250.0, 25.0);
        EXPECT_EQ(defects[1].sign, DefectSign::additional_ink);
        EXPECT_NEAR(defects[1].width_um, 1000.0 * width_mm, 4.0);
    }
}

TEST(CompareWithReference, AnotherPlace_DoesNotConverge) {
    Scene scene = good_scene();
    scene.s_mm += 0.85;
    RestImage image = take(scene, 1);
    image.axis_mm.x() -= 0.85;  // the camera believes that it is where the reference was taken
    EXPECT_TRUE(fails_with(compare_with_reference(image, drawn_reference()), Reason::no_convergence));
}

TEST(CompareWithReference, TooLittleOverlap_IsNotIdentifiable) {
    Scene scene = good_scene();
    scene.s_mm += 2.2;
    EXPECT_TRUE(
        fails_with(compare_with_reference(take(scene, 1), drawn_reference()), Reason::not_identifiable));
}

TEST(CompareWithReference, BlankPaper_HasNothingToAlignAndNoDefects) {
    const Scene blank = scene_of(320, 240);
    const RestImage reference = take(blank, 1);
    const auto comparison =
        compare_with_reference(take(blank, 2), {reference.grey, reference.axis_mm, false});
    ASSERT_TRUE(comparison) << comparison.error().text;
    EXPECT_TRUE(comparison->defects.empty());
}

}  // namespace
}  // namespace fidservo::vision::testing
