// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/stage/stage_map.h"

#include "calib/significance.h"
#include "core/failure.h"
#include "core/result.h"
#include "tests/calib/stage_views.h"

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr double noise_px = 0.01;

/// A mount that nobody would call nominal.
CameraGeometry mounted_camera() {
    CameraGeometry camera = straight_camera();
    camera.distance_mm = 20.37;
    camera.distortion.k1 = -0.25;
    camera.rotation_rad = 0.035;
    camera.tilt_rad = {0.012, -0.008};
    camera.axis_rad = {0.004, 0.001};
    return camera;
}

struct Truth {
    CameraGeometry camera = mounted_camera();
    double y_mm = 0.15;
    std::vector<double> s_mm = spread_places(12, 4.0, 190.0);

    std::vector<StageView> views(std::uint64_t seed, double std_px = noise_px) const {
        NoiseStream noise(seed, "corners");
        std::vector<StageView> all;
        for (const double s : s_mm) all.push_back(synthetic_view(camera, y_mm, s, std_px, noise));
        return all;
    }

    /// The map's numbers, stated about a middle.
    MapNumbers numbers(double middle_mm) const {
        const double length = std::sqrt(1.0 + camera.axis_rad.squaredNorm());
        MapNumbers v;
        v << camera.distance_mm - middle_mm * camera.axis_rad.y() / length, camera.rotation_rad,
            camera.tilt_rad, camera.axis_rad, camera.distortion.k1,
            y_mm + middle_mm * camera.axis_rad.x() / length;
        return v;
    }
};

TEST(StageMap, ViewsWithoutNoise_GiveTheMountBack) {
    Truth truth;
    const auto map = fit_stage_map(straight_camera(), truth.views(1, 1e-7));
    ASSERT_TRUE(map) << map.error().text;
    const MapNumbers error = map->values - truth.numbers(map->middle_mm);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-6) << error.transpose();
    EXPECT_NEAR(map->camera.distance_mm, truth.camera.distance_mm, 1e-6);
    for (std::size_t i = 0; i < truth.s_mm.size(); ++i) EXPECT_NEAR(map->s_mm[i], truth.s_mm[i], 1e-6);
}

TEST(StageMap, LargeRotation_NeedsNoGuess) {
    Truth truth;
    truth.camera.rotation_rad = 2.9;
    const auto map = fit_stage_map(straight_camera(), truth.views(1));
    ASSERT_TRUE(map) << map.error().text;
    EXPECT_NEAR(map->camera.rotation_rad, 2.9, 1e-4);
}

TEST(SlowStageMap, ErrorsOverSeeds_AreAsLargeAsTheirCovarianceSays) {
    const Truth truth;
    constexpr int seeds = 60;
    const Eigen::Vector2d from_px(150.0, 120.0), to_px(1100.0, 700.0);
    const auto vector_mm = [&](const CameraGeometry& camera) {
        return (back_project(camera, to_px, 100.0) - back_project(camera, from_px, 100.0)).eval();
    };
    double squares = 0.0, positions = 0.0, lengths = 0.0, misfit = 0.0, freedom = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto map = fit_stage_map(straight_camera(), truth.views(static_cast<std::uint64_t>(seed)));
        ASSERT_TRUE(map) << "seed " << seed << ": " << map.error().text;
        const MapNumbers error = map->values - truth.numbers(map->middle_mm);
        const double widening = map->fits ? 1.0 : map->misfit;
        squares += error.dot((map->covariance / widening).ldlt().solve(error));
        const Eigen::Vector2d missed = vector_mm(map->camera) - vector_mm(truth.camera);
        const Eigen::Matrix2d covariance =
            vector_covariance_mm2(map->camera, map->camera_covariance / widening, from_px, to_px, 100.0);
        lengths += missed.dot(covariance.ldlt().solve(missed));
        const double s_error = (map->s_mm[3] - truth.s_mm[3]) / map->s_std_mm[3];
        positions += s_error * s_error;
        misfit += map->misfit * map->freedom;
        freedom += map->freedom;
    }
    constexpr double tail = 1e-4;
    const double n = seeds * map_values;
    EXPECT_LT(squares, chi_square_bound(n, tail));
    EXPECT_GT(squares, n - (chi_square_bound(n, tail) - n));
    EXPECT_LT(lengths, chi_square_bound(2.0 * seeds, tail));
    EXPECT_GT(lengths, 2.0 * seeds - (chi_square_bound(2.0 * seeds, tail) - 2.0 * seeds));
    EXPECT_LT(positions, chi_square_bound(seeds, tail));
    EXPECT_GT(positions, seeds - (chi_square_bound(seeds, tail) - seeds));
    EXPECT_NEAR(misfit / freedom, 1.0, 5.0 * std::sqrt(2.0 / freedom));
}

TEST(StageMap, NoiseOfAHundredthOfAPixel_LeavesAMillionthOfTheScale) {
    const Truth truth;
    const auto map = fit_stage_map(straight_camera(), truth.views(5));
    ASSERT_TRUE(map) << map.error().text;
    EXPECT_LT(map->relative_scale_std(), 1e-5);
    EXPECT_LT(map->std(map_rotation), 1e-5);
    EXPECT_LT(map->std(map_axis_y), 1e-6);
}

TEST(StageMap, NoiseLargerThanStated_WidensTheCovariance) {
    const Truth truth;
    std::vector<StageView> views = truth.views(7);
    for (StageView& view : views)
        for (SeenTag& tag : view) tag.covariance_px2 /= 9.0;
    const auto honest = fit_stage_map(straight_camera(), truth.views(7));
    const auto widened = fit_stage_map(straight_camera(), views);
    ASSERT_TRUE(honest && widened);
    EXPECT_TRUE(honest->fits);
    EXPECT_FALSE(widened->fits);
    EXPECT_NEAR(widened->std(map_rotation) / honest->std(map_rotation), 1.0, 0.15);
}

TEST(StageMap, FreshViews_KeepWhatTheCovarianceSays) {
    const Truth truth;
    const auto map = fit_stage_map(straight_camera(), truth.views(3));
    ASSERT_TRUE(map) << map.error().text;
    NoiseStream noise(99, "fresh");
    double squares = 0.0, freedom = 0.0;
    for (const double s : spread_places(30, 10.0, 180.0)) {
        const ViewCheck check =
            check_view(*map, synthetic_view(truth.camera, truth.y_mm, s, noise_px, noise));
        EXPECT_NEAR(check.s_mm, s, 6.0 * check.s_std_mm);
        squares += check.chi_square;
        freedom += check.freedom;
    }
    EXPECT_LT(squares, chi_square_bound(freedom, 1e-3));
    EXPECT_GT(squares, freedom - 4.0 * std::sqrt(2.0 * freedom));
}

TEST(StageMap, FreshViewsOfAnotherCamera_DoNot) {
    const Truth truth;
    const auto map = fit_stage_map(straight_camera(), truth.views(3));
    ASSERT_TRUE(map) << map.error().text;
    CameraGeometry drifted = truth.camera;
    drifted.rotation_rad += 3e-4;
    NoiseStream noise(99, "fresh");
    const ViewCheck check = check_view(*map, synthetic_view(drifted, truth.y_mm, 50.3, noise_px, noise));
    EXPECT_GT(check.chi_square, chi_square_bound(check.freedom, 1e-6));
}

TEST(StageMap, CameraThatHardlyMoved_IsRefused) {
    Truth truth;
    truth.s_mm = {50.0, 50.1, 50.05, 50.2, 50.15};
    const auto map = fit_stage_map(straight_camera(), truth.views(1));
    ASSERT_FALSE(map);
    EXPECT_EQ(map.error().reason, Reason::not_identifiable);
    truth.s_mm = {50.0, 60.0};
    const auto few = fit_stage_map(straight_camera(), truth.views(1));
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().reason, Reason::not_identifiable);
}

}  // namespace
}  // namespace fidservo::calib
