// SPDX-License-Identifier: GPL-3.0-or-later
// A camera that is not as its file says: things in its images are where plant/camera.h puts them, and look as
// the effects' descriptions state.
#include "core/camera/camera_parameters.h"
#include "core/random.h"
#include "plant/actual_camera.h"
#include "tests/plant_view/view_fixture.h"
#include "vision/tags/tag_choice.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::plant {
namespace {

constexpr double deg = std::numbers::pi / 180.0;

struct Case {
    std::string name;
    CameraDeviation deviation;
};

std::vector<Case> geometries() {
    return {{"scale", {.pixel_scale = 1.03}},
            {"rotation", {.rotation_rad = 3.0 * deg}},
            {"tilt_about_u", {.tilt_rad = {1.0 * deg, 0.0}}},
            {"tilt_about_v", {.tilt_rad = {0.0, -2.0 * deg}}},
            {"tilt_about_the_camera", {.tilt_rad = {1.0 * deg, 0.0}, .tilt_axis_height = 1.0}},
            {"barrel", {.distortion = -0.5}},
            {"pincushion", {.distortion = 0.5}},
            {"all",
             {.pixel_scale = 0.98,
              .rotation_rad = -2.0 * deg,
              .tilt_rad = {0.7 * deg, 0.5 * deg},
              .distortion = -0.3}}};
}

/// Centre of intensity.
Eigen::Vector2d centroid_within(const cv::Mat& image, const cv::Rect& box) {
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    double sum = 0.0;
    for (int v = box.y; v < box.y + box.height; ++v)
        for (int u = box.x; u < box.x + box.width; ++u) {
            const double grey = image.at<std::uint8_t>(v, u);
            moment += grey * Eigen::Vector2d(u, v);
            sum += grey;
        }
    return moment / sum;
}

class Geometry : public testing::TestWithParam<Case> {};

TEST_P(Geometry, DotsAllOverTheImage_AreWhereTheyProject) {
    const CameraParameters camera = reference_camera();
    const ActualCamera actual = actual_camera(camera.geometry, GetParam().deviation);
    Plate plate = dark_plate();
    for (int i = -3; i <= 3; ++i)
        for (int j = -2; j <= 2; ++j)
            plate.features.push_back({"dot", Dot{{0.7 * i + 0.0013 * j, 0.7 * j + 0.0017 * i}, 0.1}, 1.0});
    constexpr double s_mm = 0.0007;
    const cv::Mat image = render_at({camera, plate, ideal_view(), GetParam().deviation}, s_mm);
    int seen = 0;
    for (const Feature& feature : plate.features) {
        const Eigen::Vector2d place = actual.image_px(std::get<Dot>(feature.shape).centre_mm, s_mm);
        constexpr int half = 24;
        const cv::Rect box(static_cast<int>(std::lround(place.x())) - half,
                           static_cast<int>(std::lround(place.y())) - half, 2 * half + 1, 2 * half + 1);
        if ((box & cv::Rect(0, 0, image.cols, image.rows)) != box) continue;
        const Eigen::Vector2d centroid = centroid_within(image, box);
        // Rounding to grey levels leaves 0.003 px; perspective moves a disc's centroid from its centre's
        // image by r^2 tan(tilt) / f = 0.001 px.
        EXPECT_LT((centroid - place).norm(), 0.012) << place.transpose();
        ++seen;
    }
    EXPECT_GE(seen, 20);
}

TEST_P(Geometry, TagsFoundInTheImage_AreWhereTheyProject) {
    const CameraParameters camera = reference_camera();
    const ActualCamera actual = actual_camera(camera.geometry, GetParam().deviation);
    Plate plate;
    for (int k = -1; k <= 1; ++k)
        plate.tags.push_back({.id = k + 5, .centre_mm = {1.9 * k, 0.2 * k}, .side_mm = 1.2});
    const PlateView view(camera, plate, ideal_view(), GetParam().deviation);
    vision::TagDetector detector;
    vision::RefinementOptions calibrated;
    calibrated.camera = actual.geometry;
    int seen = 0;
    double worst_corner_px = 0.0, worst_centre_px = 0.0;
    for (const double s_mm : {-0.8, -0.1234, 0.4}) {
        const cv::Mat image = render_at(view, s_mm);
        for (const TagDetection& tag : detector.detect(image, 0)) {
            const auto refined = vision::refine_tag(image, tag, calibrated);
            if (!refined) continue;
            ++seen;
            const PlateTag& nominal = plate.tags[static_cast<std::size_t>(tag.tag_id - 4)];
            const auto corners_mm = vision::corners_mm(nominal);
            for (std::size_t c = 0; c < 4; ++c)
                worst_corner_px = std::max(
                    worst_corner_px,
                    (refined->detection.corners_px[c] - actual.image_px(corners_mm[c], s_mm)).norm());
            worst_centre_px = std::max(
                worst_centre_px, (refined->centre_px - actual.image_px(nominal.centre_mm, s_mm)).norm());
        }
    }
    EXPECT_GE(seen, 4);
    EXPECT_LT(worst_corner_px, 0.01);
    EXPECT_LT(worst_centre_px, 0.003);
    std::printf("%-14s %d tags, corners within %.4f px, centres within %.4f px\n", GetParam().name.c_str(),
                seen, worst_corner_px, worst_centre_px);
}

INSTANTIATE_TEST_SUITE_P(Camera, Geometry, testing::ValuesIn(geometries()),
                         [](const auto& instance) { return instance.param.name; });

Plate busy_plate() {
    Plate plate;
    plate.tags.push_back({.id = 5, .centre_mm = {-0.2, 0.0}, .side_mm = 1.2, .angle_rad = 0.0122});
    plate.features.push_back({"dot", Dot{{0.7, 0.2}, 0.3}, 0.1});
    plate.features.push_back({"line", Line{{0.4, -0.4}, {1.5, -0.3}, 0.04}, 0.1});
    plate.features.push_back({"pad", Pad{{-0.9, 0.3}, {0.4, 0.2}, 0.2}, 0.3});
    plate.features.push_back({"scratch", Scratch{{{-0.8, -0.5}, {0.0, 0.5}, {0.9, 0.1}}, 0.02}, 0.7});
    return plate;
}

double worst_difference(const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_INF);
}

TEST(PlateView, HardlyWarpingCamera_GivesTheStraightPicture) {
    // Both renderers, at rest and in motion; the remaining difference is rounding and the motion kernel's 0.2
    // %.
    ViewOptions options = ideal_view();
    options.glare.push_back({{0.3, -0.5}, 0.05, 0.05});
    const PlateView straight(small_camera(480, 320), busy_plate(), options);
    const PlateView warped(small_camera(480, 320), busy_plate(), options, {.distortion = 1e-12});
    EXPECT_LE(worst_difference(render_at(straight, 0.0011), render_at(warped, 0.0011)), 1.0);
    const std::vector<double> motion{0.0, 0.01, 0.03};
    EXPECT_LE(worst_difference(straight.render(motion, 0), warped.render(motion, 0)), 2.0);
}

TEST(PlateView, TurnedCameraInMotion_SmearsAlongTheTurnedAxis) {
    // Rotated by 90 degrees, plate x runs down the image: a pad's upper and lower edges are smeared, its
    // sides are not.
    Plate plate = dark_plate();
    plate.features.push_back({"pad", Pad{{0.0, 0.0}, {0.4, 0.4}}, 1.0});
    const PlateView view(small_camera(241, 241), plate, ideal_view(), {.rotation_rad = 90.0 * deg});
    const cv::Mat image = view.render(std::vector<double>{-0.04, 0.04}, 0);
    EXPECT_NEAR(image.at<std::uint8_t>(120 - 50, 120), 128, 2);
    EXPECT_NEAR(image.at<std::uint8_t>(120 - 45, 120), 128 + 64,
                2);  // a quarter of 20 px further in
    EXPECT_EQ(image.at<std::uint8_t>(120, 120 - 45), 255);
    EXPECT_EQ(image.at<std::uint8_t>(120, 120 - 55), 0);
}

/// Standard deviation of a row's edge profile about its place: the second moment of its derivative.
double edge_width_px(const cv::Mat& image, int v) {
    double sum = 0.0, moment = 0.0, second = 0.0;
    for (int u = 0; u + 1 < image.cols; ++u) {
        const double step = image.at<std::uint8_t>(v, u + 1) - image.at<std::uint8_t>(v, u);
        sum += step;
        moment += step * (u + 0.5);
        second += step * (u + 0.5) * (u + 0.5);
    }
    return std::sqrt(second / sum - std::pow(moment / sum, 2));
}

TEST(Defocus, Edge_HasTheSumOfTheSquaresOfBothBlurs) {
    Plate plate = dark_plate();
    plate.features.push_back({"edge", Pad{{1.0, 0.0}, {2.0, 4.0}}, 1.0});
    for (const double extra_px : {0.0, 1.0, 3.0}) {
        const PlateView view(small_camera(201, 101), plate, ideal_view(), {.extra_blur_px = extra_px});
        // The pixel's area and the step to the next pixel add 1/12 each.
        const double expected = std::sqrt(0.8 * 0.8 + extra_px * extra_px + 2.0 / 12.0);
        // The profile is cut at 4.5 sigma and rounded: 0.5 grey of 255 over some 30 px.
        EXPECT_NEAR(edge_width_px(render_at(view, 0.0), 50), expected, 0.01 * expected) << extra_px;
    }
}

TEST(MotionBlur, LongerExposure_WidensAMovingEdgeByItsWay) {
    Plate plate = dark_plate();
    plate.features.push_back({"edge", Pad{{1.0, 0.0}, {2.0, 4.0}}, 1.0});
    const auto even = [](double after_s) { return 5.0 * after_s; };
    for (const double extra_s : {0.0, 0.004, 0.01}) {
        const PlateView view(small_camera(201, 101), plate, ideal_view(), {.extra_exposure_s = extra_s});
        const double way_px = 5.0 * (0.002 + extra_s) / 0.004;
        const double expected = std::sqrt(0.8 * 0.8 + 2.0 / 12.0 + way_px * way_px / 12.0);
        EXPECT_NEAR(edge_width_px(view.expose(even, 0), 50), expected, 0.01 * expected) << extra_s;
    }
}

/// Place of a row's edge: the centre of its derivative.
double edge_place_px(const cv::Mat& image, int v) {
    double sum = 0.0, moment = 0.0;
    for (int u = 0; u + 1 < image.cols; ++u) {
        const double step = image.at<std::uint8_t>(v, u + 1) - image.at<std::uint8_t>(v, u);
        sum += step;
        moment += step * (u + 0.5);
    }
    return moment / sum;
}

TEST(RollingShutter, EvenMotion_ShearsAnEdgeBySpeedAndReadout) {
    Plate plate = dark_plate();
    plate.features.push_back({"edge", Pad{{1.0, 0.0}, {2.0, 4.0}}, 1.0});
    constexpr double speed_mm_per_s = 8.0;
    const auto even = [](double after_s) { return speed_mm_per_s * after_s; };
    for (const double readout_s : {-0.01, 0.01}) {
        for (const double rotation_rad : {0.0, 1e-9}) {  // both renderers
            const PlateView view(small_camera(241, 201), plate, ideal_view(),
                                 {.rotation_rad = rotation_rad, .readout_s = readout_s});
            const cv::Mat image = view.expose(even, 0);
            for (const int v : {0, 50, 100, 150, 200}) {
                const double expected = 120.0 - speed_mm_per_s * readout_s * (v / 200.0 - 0.5) / 0.004;
                EXPECT_NEAR(edge_place_px(image, v), expected, 0.01) << v << ' ' << readout_s;
            }
        }
    }
}

TEST(RollingShutter, CameraAtRest_SeesTheSameBytes) {
    const PlateView at_once(small_camera(480, 320), busy_plate(), {});
    const PlateView rolling(small_camera(480, 320), busy_plate(), {}, {.readout_s = 0.01});
    const auto rest = [](double) { return 0.0123; };
    EXPECT_EQ(worst_difference(at_once.expose(rest, 4), rolling.expose(rest, 4)), 0.0);
}

TEST(UnevenLight, AddedFallOff_FollowsItsFormula) {
    Plate plate;
    plate.paper_reflectance = 0.5;
    const PlateView view(small_camera(641, 481), plate, ideal_view(),
                         {.light_gradient = {0.2, -0.1}, .vignetting = 0.3});
    const cv::Mat image = render_at(view, 0.0);
    const auto expect_grey = [&](int u, int v, double x, double y) {
        EXPECT_NEAR(image.at<std::uint8_t>(v, u),
                    127.5 * (1.0 + 0.2 * x - 0.1 * y) * (1.0 - 0.15 * (x * x + y * y)), 0.51);
    };
    expect_grey(320, 240, 0.0, 0.0);
    expect_grey(0, 0, -1.0, -1.0);
    expect_grey(640, 480, 1.0, 1.0);
    expect_grey(640, 0, 1.0, -1.0);
    expect_grey(480, 120, 0.5, -0.5);
}

TEST(SensorNoise, Variance_IsTheSumOfShotReadAndAddedNoise) {
    Plate plate;
    plate.paper_reflectance = 0.5;
    ViewOptions options = ideal_view();
    options.noise = true;
    for (const double extra_e : {0.0, 40.0, 120.0}) {
        const PlateView view(small_camera(400, 300), plate, options, {.extra_read_noise_e = extra_e});
        cv::Scalar mean, deviation;
        cv::meanStdDev(render_at(view, 0.0), mean, deviation);
        const double grey_per_e = 255.0 / 10000.0, electrons = 5000.0;
        const double expected = grey_per_e * grey_per_e * (electrons + 25.0 + extra_e * extra_e) + 1.0 / 12.0;
        // The sample variance of 120,000 pixels scatters by sqrt(2 / n) of itself.
        EXPECT_NEAR(deviation[0] * deviation[0], expected, 4.5 * std::sqrt(2.0 / 120000.0) * expected)
            << extra_e;
    }
}

}  // namespace
}  // namespace fidservo::plant
