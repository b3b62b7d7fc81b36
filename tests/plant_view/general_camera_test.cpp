// SPDX-License-Identifier: GPL-3.0-or-later
// A rig file's camera may itself be turned, tilted and distorting: what it sees is where
// core/camera/camera_geometry.h says, to a few thousandths of a pixel.
#include "core/camera/camera_parameters.h"
#include "core/camera/camera_slopes.h"
#include "plant/actual_camera.h"
#include "tests/plant_view/view_fixture.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo::plant {
namespace {

constexpr double deg = std::numbers::pi / 180.0;
constexpr double s_mm = 100.0307;

struct Case {
    std::string name;
    CameraGeometry camera;
    CameraDeviation deviation;
};

CameraGeometry general_camera() {
    CameraGeometry camera = reference_camera().geometry;
    camera.focal_ratio = 1.003;
    camera.distortion = {.k1 = -0.2, .k2 = 0.5, .p1 = 0.002, .p2 = -0.001, .k3 = 2.0};
    camera.rotation_rad = 1.0 * deg;
    camera.tilt_rad = {2.0 * deg, -2.236 * deg};
    camera.axis_rad = {0.0005, 0.0004};
    return camera;
}

std::vector<Case> cameras() {
    const auto straight_but = [](auto change) {
        CameraGeometry camera = reference_camera().geometry;
        change(camera);
        return camera;
    };
    return {{"straight", reference_camera().geometry, {}},
            {"turned", straight_but([](CameraGeometry& c) { c.rotation_rad = 0.7 * deg; }), {}},
            {"oblong_pixels", straight_but([](CameraGeometry& c) { c.focal_ratio = 0.99; }), {}},
            {"oblique_axis",
             straight_but([](CameraGeometry& c) {
                 c.axis_rad = {0.0005, 0.001};
             }),
             {}},
            {"general", general_camera(), {}},
            {"general_and_deviating",
             general_camera(),
             {.pixel_scale = 1.01,
              .rotation_rad = -2.0 * deg,
              .tilt_rad = {0.0, 0.5 * deg},
              .tilt_axis_height = 0.6,
              .distortion = 0.1}}};
}

class GeneralCamera : public testing::TestWithParam<Case> {
  protected:
    CameraParameters camera() const {
        CameraParameters parameters = reference_camera();
        parameters.geometry = GetParam().camera;
        return parameters;
    }
    ActualCamera actual() const { return actual_camera(GetParam().camera, GetParam().deviation); }
    /// Plate point seen in the image's middle.
    Eigen::Vector2d middle_mm() const { return actual().plate_mm({639.5, 479.5}, s_mm); }
};

/// Centre of the area that a disc covers in the image; the image of its centre lies beside it.
Eigen::Vector2d centre_of_disc(const ActualCamera& camera, const Dot& dot) {
    constexpr int rings = 12, sectors = 48;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    double area = 0.0;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < sectors; ++k) {
            const double r = 0.5 * dot.diameter_mm * std::sqrt((i + 0.5) / rings);  // equal areas
            const double angle = 2.0 * std::numbers::pi * (k + 0.5) / sectors;
            const Eigen::Vector2d place =
                camera.image_px(dot.centre_mm + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)), s_mm);
            const double weight = 1.0 / plate_by_image(camera.geometry, place, s_mm).determinant();
            moment += weight * place;
            area += weight;
        }
    return moment / area;
}

TEST_P(GeneralCamera, Dots_CoverTheImageWhereTheyProject) {
    Plate plate = dark_plate();
    for (int i = -2; i <= 2; ++i)
        for (int j = -1; j <= 1; ++j)
            plate.features.push_back(
                {"dot", Dot{middle_mm() + Eigen::Vector2d(0.9 * i + 0.0013 * j, 1.1 * j + 0.0017 * i), 0.4},
                 1.0});
    const cv::Mat image = render_at({camera(), plate, ideal_view(), GetParam().deviation}, s_mm);
    int seen = 0;
    double worst_px = 0.0;
    for (const Feature& feature : plate.features) {
        const Eigen::Vector2d place = centre_of_disc(actual(), std::get<Dot>(feature.shape));
        constexpr int half = 70;
        const cv::Rect box(static_cast<int>(std::lround(place.x())) - half,
                           static_cast<int>(std::lround(place.y())) - half, 2 * half + 1, 2 * half + 1);
        if ((box & cv::Rect(0, 0, image.cols, image.rows)) != box) continue;
        const cv::Moments moments = cv::moments(image(box));
        const Eigen::Vector2d centroid(box.x + moments.m10 / moments.m00, box.y + moments.m01 / moments.m00);
        worst_px = std::max(worst_px, (centroid - place).norm());
        ++seen;
    }
    EXPECT_GE(seen, 9);
    EXPECT_LT(worst_px, 0.002);
    RecordProperty("worst_px", std::to_string(worst_px));
}

/// Where row v of the image crosses the straight piece of plate from a to b, u in px.
double crossing_px(const ActualCamera& camera, Eigen::Vector2d a, Eigen::Vector2d b, int v) {
    for (int k = 0; k < 50; ++k) {
        const Eigen::Vector2d middle = 0.5 * (a + b);
        const bool below = (camera.image_px(middle, s_mm).y() - v) * (camera.image_px(b, s_mm).y() - v) < 0.0;
        (below ? a : b) = middle;
    }
    return camera.image_px(a, s_mm).x();
}

TEST_P(GeneralCamera, TagsBorders_LieWhereTheyProject) {
    Plate plate = dark_plate();  // the border is white here
    for (int i = -1; i <= 1; ++i)
        plate.tags.push_back({.id = 5 + i,
                              .centre_mm = middle_mm() + Eigen::Vector2d(1.55 * i, 0.4 * i),
                              .side_mm = 1.2,
                              .angle_rad = 0.03});
    const cv::Mat image = render_at({camera(), plate, ideal_view(), GetParam().deviation}, s_mm);
    for (const PlateTag& tag : plate.tags) {
        const Eigen::Vector2d x(std::cos(tag.angle_rad), std::sin(tag.angle_rad));
        const Eigen::Vector2d y(-x.y(), x.x());
        const Eigen::Vector2d left = tag.centre_mm - 0.5 * tag.side_mm * x;
        const Eigen::Vector2d middle = actual().image_px(left, s_mm);
        const int inside_px = static_cast<int>(std::lround(middle.x())) + 18;
        double sum_px = 0.0;
        int rows = 0;
        for (int v = static_cast<int>(middle.y()) - 50; v < middle.y() + 50; ++v) {
            double covered_px = 0.0;
            for (int u = inside_px - 36; u <= inside_px; ++u)
                covered_px += image.at<std::uint8_t>(v, u) / 255.0;
            const double found_px = inside_px + 0.5 - covered_px;
            sum_px += found_px -
                      crossing_px(actual(), left - 0.5 * tag.side_mm * y, left + 0.5 * tag.side_mm * y, v);
            ++rows;
        }
        EXPECT_NEAR(sum_px / rows, 0.0, 0.002) << "tag " << tag.id;
    }
}

INSTANTIATE_TEST_SUITE_P(Camera, GeneralCamera, testing::ValuesIn(cameras()),
                         [](const auto& instance) { return instance.param.name; });

TEST(PlateView, NominalGainSpread_IsThePixelsOwn) {
    Plate plate;
    CameraParameters camera = small_camera(160, 120);
    ViewOptions options;
    options.pixel_gain_spread = 0.02;
    const cv::Mat as_option = render_at({camera, plate, options}, 0.0);
    camera.gain_spread = 0.02;
    EXPECT_EQ(cv::norm(as_option, render_at({camera, plate, {}}, 0.0), cv::NORM_INF), 0.0);
}

TEST(PlateView, MovingTurnedCamera_SmearsLikeOneThatPaintsRowByRow) {
    // The same plate rotated the other way, so that both views see the same image: one by each renderer.
    constexpr double angle = 0.7 * deg;
    Plate plate;
    plate.tags.push_back({.id = 5, .centre_mm = {0.0, 0.0}, .side_mm = 1.2, .angle_rad = 0.01});
    Plate turned_plate = plate;
    turned_plate.tags[0].angle_rad -= angle;
    CameraParameters camera = small_camera(480, 400);
    camera.geometry.rotation_rad = angle;
    const cv::Mat turned = render_at({camera, turned_plate, ideal_view()}, 0.0);
    const cv::Mat straight = render_at({small_camera(480, 400), plate, ideal_view()}, 0.0);
    EXPECT_LE(cv::norm(turned, straight, cv::NORM_INF), 1.0);
    // Motion just above a hundredth of a pixel makes the other renderer take over.
    const std::vector<double> creeping{-0.000041, 0.000041};
    const cv::Mat crept = PlateView(camera, turned_plate, ideal_view()).render(creeping, 0);
    EXPECT_LE(cv::norm(turned, crept, cv::NORM_INF), 1.0);
}

}  // namespace
}  // namespace fidservo::plant
