// SPDX-License-Identifier: GPL-3.0-or-later
// Printed features under a camera that is turned, tilted, distorting, on an oblique axis: measured in its
// image, stated on the plate.
#include "tests/vision_features/scene.h"
#include "vision/features/edge_distance.h"
#include "vision/features/line.h"
#include "vision/features/mark.h"
#include "vision/features/pad.h"
#include "vision/features/reference_compare.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::vision::testing {
namespace {

Scene scene_seen_aslant() {
    Scene scene = scene_of(1280, 960);
    CameraGeometry& camera = scene.camera.geometry;
    camera.focal_ratio = 1.002;
    camera.distortion = {.k1 = -0.2, .k2 = 0.05, .p1 = 0.001, .p2 = -0.0005};
    camera.rotation_rad = 0.0175;
    camera.tilt_rad = {0.035, -0.039};
    camera.axis_rad = {0.0005, -0.0003};
    return scene;
}

/// Places all over the image, on the plate.
std::array<Eigen::Vector2d, 5> places(const Scene& scene) {
    const auto place = [&](double u, double v) {
        return back_project(scene.camera.geometry, {u, v}, scene.s_mm);
    };
    return {place(640, 480), place(250, 200), place(1030, 200), place(250, 760), place(1030, 760)};
}

void expect_covered(const Measured& measured, double truth, double limit, const char* what) {
    EXPECT_NEAR(measured.value, truth, 3.0 * measured.std) << what;
    EXPECT_LT(measured.std, limit) << what;
}

TEST(SeenAslant, Dots_HaveTheirPlaceAndDiameter) {
    Scene scene = scene_seen_aslant();
    for (const Eigen::Vector2d& at : places(scene)) scene.print(Dot{at, 0.4});
    const RestImage image = take(scene, 1);
    for (const Eigen::Vector2d& at : places(scene)) {
        const auto dot = measure_dot(image, {at + Eigen::Vector2d(0.01, -0.02), 0.4}, {});
        ASSERT_TRUE(dot) << dot.error().text;
        expect_covered(dot->x_um, 1000.0 * at.x(), 0.35, "x");
        expect_covered(dot->y_um, 1000.0 * at.y(), 0.35, "y");
        expect_covered(dot->diameter_um, 400.0, 0.7, "diameter");
    }
}

TEST(SeenAslant, Pads_HaveTheirPlaceSizeAndAngle) {
    Scene scene = scene_seen_aslant();
    constexpr double angle_rad = 0.1;
    for (const Eigen::Vector2d& at : places(scene)) scene.print(Pad{at, {0.6, 0.4}, angle_rad});
    const RestImage image = take(scene, 2);
    for (const Eigen::Vector2d& at : places(scene)) {
        const auto pad = measure_pad(image, {at + Eigen::Vector2d(0.01, -0.02), {0.6, 0.4}, angle_rad}, {});
        ASSERT_TRUE(pad) << pad.error().text;
        expect_covered(pad->x_um, 1000.0 * at.x(), 0.5, "x");
        expect_covered(pad->y_um, 1000.0 * at.y(), 0.5, "y");
        expect_covered(pad->width_um, 600.0, 0.5, "width");
        expect_covered(pad->height_um, 400.0, 0.5, "height");
        expect_covered(pad->angle_rad, angle_rad, 2e-3, "angle");
    }
}

TEST(SeenAslant, Lines_HaveTheirWidthAndOffset) {
    Scene scene = scene_seen_aslant();
    const auto line_at = [](const Eigen::Vector2d& at) {
        return Line{at - Eigen::Vector2d(0.5, 0.05), at + Eigen::Vector2d(0.5, 0.05), 0.12};
    };
    for (const Eigen::Vector2d& at : places(scene)) scene.print(line_at(at));
    const RestImage image = take(scene, 3);
    for (const Eigen::Vector2d& at : places(scene)) {
        const auto line = measure_line(image, line_at(at), {});
        ASSERT_TRUE(line) << line.error().text;
        expect_covered(line->offset_um, 0.0, 0.8, "offset");
        EXPECT_NEAR(line->width_um.value, 120.0, 0.1);
        EXPECT_NEAR(line->angle_rad.value, std::atan2(0.1, 1.0), 1e-3);
    }
}

TEST(SeenAslant, EdgeDistances_AreThePlates) {
    Scene scene = scene_seen_aslant();
    const auto pads_at = [](const Eigen::Vector2d& at) {
        return std::pair(Pad{at - Eigen::Vector2d(0.3, 0.0), {0.3, 0.4}},
                         Pad{at + Eigen::Vector2d(0.3, 0.0), {0.3, 0.4}});
    };
    for (const Eigen::Vector2d& at : places(scene)) {
        scene.print(pads_at(at).first);
        scene.print(pads_at(at).second);
    }
    const RestImage image = take(scene, 4);
    for (const Eigen::Vector2d& at : places(scene)) {
        const auto [left, right] = pads_at(at);
        const auto edges = facing_edges(edges_of(left), edges_of(right));
        ASSERT_TRUE(edges);
        const auto distance = measure_edge_distance(image, edges->first, edges->second, {});
        ASSERT_TRUE(distance) << distance.error().text;
        expect_covered(distance->distance_um, 300.0, 0.5, "distance");
    }
}

TEST(SeenAslant, DrawnReference_ShowsTheDefectAtItsPlaceAndNothingElse) {
    Scene good = scene_seen_aslant();
    for (const Eigen::Vector2d& at : places(good)) good.print(Pad{at, {0.6, 0.4}});
    Scene spoilt = good;
    const Eigen::Vector2d stain_mm = places(good)[4] + Eigen::Vector2d(0.1, -0.4);
    spoilt.print(Dot{stain_mm, 0.03});
    good.view.light = {.level = 1.0, .gradient = {0.0, 0.0}, .vignetting = 0.0};
    const RestImage drawn = draw(good);
    const auto compared = compare_with_reference(take(spoilt, 5), {drawn.grey, drawn.axis_mm, true});
    ASSERT_TRUE(compared) << compared.error().text;
    ASSERT_EQ(compared->defects.size(), 1U);
    EXPECT_LT((compared->defects[0].centre_mm - stain_mm).norm(), 0.002);
    EXPECT_NEAR(compared->defects[0].equivalent_diameter_um, 30.0, 4.0);
}

TEST(SeenAslant, ReferenceTakenBesideIt_IsBroughtIntoRegister) {
    Scene scene = scene_seen_aslant();
    for (const Eigen::Vector2d& at : places(scene)) scene.print(Pad{at, {0.6, 0.4}});
    Scene beside = scene;
    beside.s_mm += 0.003;
    const RestImage reference = take(beside, 6);
    const auto compared = compare_with_reference(take(scene, 7), {reference.grey, reference.axis_mm, false});
    ASSERT_TRUE(compared) << compared.error().text;
    EXPECT_LT(compared->misregistration_px.norm(), 0.02);
    EXPECT_TRUE(compared->defects.empty());
}

}  // namespace
}  // namespace fidservo::vision::testing
