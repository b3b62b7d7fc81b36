// SPDX-License-Identifier: GPL-3.0-or-later
// Equidistant lenses are found from corners alone, with valid standard errors, and in agreement with OpenCV.
#include "calib/camera/calibration_verdict.h"
#include "calib/camera/plane_pose.h"
#include "tests/calib_camera/hand_held.h"
#include "tests/effort.h"

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace fidservo::calib {
namespace {

constexpr std::uint64_t seed = 5;

/// 195 degrees in the circle that the image holds.
CameraGeometry wide_fisheye() {
    CameraGeometry lens{512, 512, 191.0, {254.9, 256.9}, 1.0};
    lens.distortion = {
        .k1 = 0.0035, .k2 = 0.0007, .k3 = -0.00205, .k4 = 0.0002, .model = LensModel::equidistant};
    return lens;
}

std::vector<PlateTag> target() {
    return tag_grid(6, 6, 88.0, 114.4);
}

LensMask all_four() {
    LensMask mask{};
    for (const LensParameter parameter : {focal, centre_u, centre_v, k1, k2, k3, k4}) mask[parameter] = true;
    return mask;
}

TEST(FisheyeCalibration, WithoutNoise_IsFoundExactly) {
    NoiseStream random(seed, "fisheye exact");
    const CameraGeometry lens = wide_fisheye();
    CameraCalibrationOptions options = options_for_lens(lens, LensModel::equidistant);
    options.fitted = all_four();
    const auto found = calibrate_camera(
        hand_held_views(lens, target(), {.most_off_axis_rad = 1.3, .noise_px = 1e-6}, random), options);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_NEAR(found->camera.focal_px, lens.focal_px, 1e-4);
    EXPECT_LT((found->camera.principal_point_px - lens.principal_point_px).norm(), 1e-4);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(numbers_of(found->camera.distortion)[k], numbers_of(lens.distortion)[k], 1e-6);
    EXPECT_LT(found->rms_px, 1e-5);
    EXPECT_EQ(found->unused, 0U);
}

/// Errors in standard deviations over many noises: none beyond 4, as many within 2 as normal ones are.
TEST(SlowFisheyeCalibration, StandardErrors_HoldOverManyDraws) {
    const int draws = testing::draws(100, 30);
    const CameraGeometry lens = wide_fisheye();
    const std::vector<PlateTag> tags = tag_grid(4, 4, 88.0, 114.4);
    int numbers = 0, within_two = 0;
    double squares = 0.0;
    for (int draw = 1; draw <= draws; ++draw) {
        NoiseStream random(static_cast<std::uint64_t>(draw), "fisheye coverage");
        CameraCalibrationOptions options = options_for_lens(lens, LensModel::equidistant);
        options.fitted = all_four();
        const auto found = calibrate_camera(
            hand_held_views(lens, tags, {.views = 8, .most_off_axis_rad = 1.3}, random), options);
        ASSERT_TRUE(found) << "draw " << draw << ": " << found.error().text;
        const Lens is = lens_of(found->camera), was = lens_of(lens);
        for (std::size_t k = 0; k < lens_parameters; ++k) {
            if (!found->fitted[k]) continue;
            const double error = (is[k] - was[k]) / found->std_of(static_cast<LensParameter>(k));
            EXPECT_LT(std::abs(error), 4.0)
                << "draw " << draw << ", " << name_of(static_cast<LensParameter>(k));
            squares += error * error;
            within_two += std::abs(error) < 2.0 ? 1 : 0;
            ++numbers;
        }
    }
    const double share = static_cast<double>(within_two) / numbers;
    std::printf("%d numbers of %d draws: mean square %.2f in their variances, %.1f %% within two\n", numbers,
                draws, squares / numbers, 100.0 * share);
    // The numbers of a draw are correlated, so the interval is that of as many independent values as there
    // are draws.
    EXPECT_NEAR(squares / numbers, 1.0, 4.0 * std::sqrt(2.0 / draws));
    EXPECT_NEAR(share, 0.9545, 4.0 * std::sqrt(0.9545 * 0.0455 / draws));
}

/// OpenCV starts from a guess and weighs all corners alike, as is right here.
TEST(FisheyeCalibration, Result_IsOpenCVsWithinAStandardErrorAndItsResidualsByOpenCV) {
    NoiseStream random(seed, "fisheye opencv");
    CameraGeometry lens = wide_fisheye();
    const auto views = hand_held_views(
        lens, target(), {.views = 12, .most_tilt_rad = 0.5, .most_off_axis_rad = 0.15}, random);
    CameraCalibrationOptions options = options_for_lens(lens, LensModel::equidistant);
    options.fitted = all_four();
    (*options.fitted)[focal_ratio] = true;
    const auto ours = calibrate_camera(views, options);
    ASSERT_TRUE(ours) << ours.error().text;
    ASSERT_EQ(ours->unused, 0U);

    std::vector<std::vector<cv::Point3d>> printed;
    std::vector<std::vector<cv::Point2d>> seen;
    for (const TargetView& view : views) {
        auto& points = printed.emplace_back();
        auto& pixels = seen.emplace_back();
        for (const TagSight& sight : view.tags) {
            const auto corners_mm = vision::corners_mm(sight.printed);
            for (std::size_t k = 0; k < 4; ++k) {
                const Eigen::Vector2d& at = sight.seen.detection.corners_px[k];
                points.emplace_back(corners_mm[k].x(), corners_mm[k].y(), 0.0);
                pixels.emplace_back(at.x(), at.y());
            }
        }
    }
    cv::Matx33d matrix(190.0, 0.0, 255.5, 0.0, 190.0, 255.5, 0.0, 0.0, 1.0);
    cv::Vec4d four(0.0, 0.0, 0.0, 0.0);
    std::vector<cv::Mat> turns, shifts;
    cv::fisheye::calibrate(printed, seen, cv::Size(lens.width_px, lens.height_px), matrix, four, turns,
                           shifts, cv::fisheye::CALIB_USE_INTRINSIC_GUESS | cv::fisheye::CALIB_FIX_SKEW,
                           cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-12));
    // Its numbers and ours agree to a standard error, not to rounding; why was not found out.
    const auto expect_same = [&](LensParameter parameter, double is, double theirs) {
        EXPECT_NEAR(is, theirs, ours->std_of(parameter)) << name_of(parameter);
    };
    expect_same(focal, ours->camera.focal_px, matrix(0, 0));
    expect_same(focal_ratio, ours->camera.focal_ratio, matrix(1, 1) / matrix(0, 0));
    expect_same(centre_u, ours->camera.principal_point_px.x(), matrix(0, 2));
    expect_same(centre_v, ours->camera.principal_point_px.y(), matrix(1, 2));
    const std::vector<double> numbers = numbers_of(ours->camera.distortion);
    for (int k = 0; k < 4; ++k) {
        constexpr std::array coefficients{k1, k2, k3, k4};
        expect_same(coefficients[static_cast<std::size_t>(k)], numbers[static_cast<std::size_t>(k)], four[k]);
    }
    // OpenCV's projection at our minimum gives our residuals.
    double squares_px2 = 0.0, corners = 0.0;
    const cv::Matx33d found_matrix(ours->camera.focal_px, 0.0, ours->camera.principal_point_px.x(), 0.0,
                                   ours->camera.focal_px * ours->camera.focal_ratio,
                                   ours->camera.principal_point_px.y(), 0.0, 0.0, 1.0);
    for (std::size_t view = 0; view < printed.size(); ++view) {
        const PlanePose& pose = ours->views[view].pose;
        const Eigen::AngleAxisd turn(pose.turn);
        const Eigen::Vector3d axis = turn.angle() * turn.axis();
        std::vector<cv::Point2d> shown;
        cv::fisheye::projectPoints(printed[view], shown, cv::Vec3d(axis.x(), axis.y(), axis.z()),
                                   cv::Vec3d(pose.shift_mm.x(), pose.shift_mm.y(), pose.shift_mm.z()),
                                   found_matrix, cv::Vec4d(numbers[0], numbers[1], numbers[2], numbers[3]));
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const cv::Point2d error = shown[k] - seen[view][k];
            squares_px2 += error.dot(error);
            corners += 1.0;
        }
    }
    EXPECT_NEAR(ours->rms_px, std::sqrt(squares_px2 / corners), 1e-6);
}

TEST(SlowFisheyeCalibration, TakenForPlumbBob_IsToldToBeAFisheyeAndNothingElse) {
    NoiseStream random(seed, "fisheye advice");
    const CameraGeometry lens = wide_fisheye();
    const auto views = hand_held_views(lens, target(), {.views = 6, .most_off_axis_rad = 0.8}, random);
    const auto found = calibrate_camera(views, options_for_lens(lens, LensModel::plumb_bob));
    ASSERT_TRUE(found) << found.error().text;
    const auto reasons = shortcomings(*found, {.least_coverage = 0.0}, target());
    ASSERT_EQ(reasons.size(), 1U);
    EXPECT_NE(reasons[0].find("the reprojection error is too large"), std::string::npos) << reasons[0];
    EXPECT_NE(reasons[0].find("--lens equidistant"), std::string::npos) << reasons[0];
    EXPECT_EQ(reasons[0].find("tilt"), std::string::npos) << reasons[0];
}

TEST(FisheyeCalibration, PoseByRaysFromBehindTheCamera_IsFound) {
    NoiseStream random(seed, "fisheye pose");
    const CameraGeometry lens = wide_fisheye();
    // A target 90 degrees off the axis towards a corner of the image, facing the camera: some of it is behind
    // the camera's centre.
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d(-1.0, 1.0, 0.0).normalized())
            .toRotationMatrix();
    const Eigen::Vector3d shift_mm(500.0, 500.0, 20.0);
    const TargetView view = view_at(lens, target(), turn, shift_mm, 1e-6, random);
    ASSERT_GE(view.tags.size(), 8U);
    int behind = 0;
    for (const TagSight& sight : view.tags)
        for (const Eigen::Vector2d& corner_mm : vision::corners_mm(sight.printed))
            behind += (turn.leftCols<2>() * corner_mm + shift_mm).z() < 0.0 ? 1 : 0;
    ASSERT_GE(behind, 4);
    const auto pose = plane_pose(lens, view);
    ASSERT_TRUE(pose);
    EXPECT_LT((pose->turn - turn).norm(), 1e-5);
    EXPECT_LT((pose->shift_mm - shift_mm).norm(), 1e-3);
}

}  // namespace
}  // namespace fidservo::calib
