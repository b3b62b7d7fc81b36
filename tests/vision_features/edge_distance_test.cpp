// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/edge_distance.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "tests/vision_features/consistency.h"
#include "tests/vision_features/scene.h"

#include <cmath>

namespace fidservo::vision::testing {
namespace {

/// Two pads side by side, `gap_mm` apart, the gap's middle at x = 100 mm + shift.
struct Pair {
    Pad left;
    Pad right;
};
Pair pads_apart(double gap_mm, double shift_mm = 0.0, double turn_rad = 0.0) {
    return {{{99.85 + shift_mm - gap_mm / 2, 0.0}, {0.3, 0.3}},
            {{100.15 + shift_mm + gap_mm / 2, 0.0}, {0.3, 0.3}, turn_rad}};
}

Scene scene_with(const Pair& pads) {
    Scene scene = scene_of(200, 160);
    scene.print(pads.left);
    scene.print(pads.right);
    return scene;
}

std::pair<NominalEdge, NominalEdge> gap_edges(const Pair& pads) {
    return facing_edges(edges_of(pads.left), edges_of(pads.right)).value();
}

TEST(FacingEdges, OfTwoPads_AreThoseAcrossTheGap) {
    const auto edges = gap_edges(pads_apart(0.06));
    EXPECT_TRUE(edges.first.outward.isApprox(Eigen::Vector2d(1.0, 0.0)));
    EXPECT_TRUE(edges.second.outward.isApprox(Eigen::Vector2d(-1.0, 0.0)));
    EXPECT_NEAR(edges.second.from_mm.x() - edges.first.from_mm.x(), 0.06, 1e-12);
}

TEST(FacingEdges, OfATagAndALineBelowIt_AreTheBorderAndTheLinesUpperEdge) {
    const PlateTag tag{7, {14.0, 0.0}, 1.2};
    const Line line{{13.0, 0.9}, {15.0, 0.9}, 0.1};
    const auto edges = facing_edges(edges_of(tag), edges_of(line));
    ASSERT_TRUE(edges);
    EXPECT_NEAR(edges->first.from_mm.y(), 0.6, 1e-12);
    EXPECT_NEAR(edges->second.from_mm.y(), 0.85, 1e-12);
}

TEST(FacingEdges, OfPadsThatDoNotOverlap_AreNone) {
    const Pad a{{0.0, 0.0}, {0.2, 0.2}};
    EXPECT_FALSE(facing_edges(edges_of(a), edges_of(Pad{{0.5, 0.5}, {0.2, 0.2}})));
    EXPECT_FALSE(facing_edges(edges_of(a), edges_of(Pad{{0.4, 0.0}, {0.2, 0.2}, 0.3})));
}

TEST(SlowMeasureEdgeDistance, RandomGaps_ErrorsFollowTheStatedUncertainty) {
    constexpr std::uint64_t seed = 20291;
    SCOPED_TRACE(seed);
    NoiseStream random(seed, "gaps");
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    const auto nominal = gap_edges(pads_apart(0.06));
    Consistency distance, inclination;
    for (int trial = 0; trial < 250; ++trial) {
        const double gap_mm = between(0.04, 0.1);
        const Pair pads = pads_apart(gap_mm, between(-0.03, 0.03));
        const auto measured =
            measure_edge_distance(take(scene_with(pads), seed + trial), nominal.first, nominal.second);
        ASSERT_TRUE(measured) << "trial " << trial << ": " << measured.error().text;
        distance.add(measured->distance_um, 1000.0 * gap_mm);
        inclination.add(measured->inclination_rad, 0.0);
    }
    expect_consistent(distance, 0.006, "distance");
    expect_consistent(inclination, 1e-4, "inclination");
}

TEST(MeasureEdgeDistance, TagToPad_IsMeasured) {
    Scene scene = scene_of(400, 200);
    const PlateTag tag{5, {99.3, 0.0}, 1.2};
    const Pad pad{{100.2, 0.0}, {0.3, 0.2}};
    scene.plate.tags.push_back(tag);
    scene.print(pad);
    const auto edges = facing_edges(edges_of(tag), edges_of(pad));
    ASSERT_TRUE(edges);
    const auto measured = measure_edge_distance(take(scene, 1), edges->first, edges->second);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->distance_um.value, 150.0, 5.0 * measured->distance_um.std);
    EXPECT_NEAR(measured->on_a_mm.x(), 99.9, 1e-4);
    EXPECT_NEAR(measured->on_b_mm.x(), 100.05, 1e-4);
}

TEST(MeasureEdgeDistance, InclinedEdge_IsReported) {
    const Pair pads = pads_apart(0.07, 0.0, 0.02);
    const auto nominal = gap_edges(pads_apart(0.07));
    const auto measured = measure_edge_distance(take(scene_with(pads), 1), nominal.first, nominal.second);
    ASSERT_TRUE(measured) << measured.error().text;
    EXPECT_NEAR(measured->inclination_rad.value, 0.02, 5.0 * measured->inclination_rad.std);
}

TEST(MeasureEdgeDistance, OneFeatureMissing_IsNotFound) {
    const Pair pads = pads_apart(0.06);
    Scene scene = scene_of(200, 160);
    scene.print(pads.left);
    const auto nominal = gap_edges(pads);
    EXPECT_TRUE(fails_with(measure_edge_distance(take(scene, 1), nominal.first, nominal.second),
                           Reason::feature_not_found));
}

TEST(MeasureEdgeDistance, OutsideTheImage_IsNotIdentifiable) {
    Scene scene = scene_with(pads_apart(0.06));
    scene.s_mm = 100.5;
    const auto nominal = gap_edges(pads_apart(0.06));
    EXPECT_TRUE(fails_with(measure_edge_distance(take(scene, 1), nominal.first, nominal.second),
                           Reason::not_identifiable));
}

}  // namespace
}  // namespace fidservo::vision::testing
