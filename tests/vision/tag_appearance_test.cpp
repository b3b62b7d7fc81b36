// SPDX-License-Identifier: GPL-3.0-or-later
// Blur, brightness and noise of tags in rendered frames, against what they were rendered with. Limits are
// what gap/links/image_link.h allows for.
#include "vision/tags/tag_appearance.h"

#include "core/camera/camera_parameters.h"
#include "core/plate.h"
#include "plant/view/plate_view.h"
#include "tests/reference_camera.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

constexpr double side_mm = 1.2, pixel_variance = 1.0 / 12.0;

/// A tag of the reference rig, turned, its centre at (x_mm, 0) from the image's middle.
struct Setting {
    plant::CameraDeviation deviation;
    plant::Light light = {};
    double angle_rad = 0.0, x_mm = 0.0;
    double speed_mm_per_s = 0.0;
};

TagDetection detection_of(const Setting& setting, const CameraParameters& camera) {
    TagDetection tag;
    tag.tag_id = 7;
    const Eigen::Rotation2Dd turn(setting.angle_rad);
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d corner_mm =
            Eigen::Vector2d(setting.x_mm, 0.0) + 0.5 * side_mm * (turn * tag_corners[k]);
        tag.corners_px[k] = camera.geometry.principal_point_px + corner_mm / 0.004;
    }
    return tag;
}

std::vector<TagAppearance> appearances(const Setting& setting, int frames) {
    const CameraParameters camera = reference_camera();
    Plate plate;
    plate.tags.push_back({7, {setting.x_mm, 0.0}, side_mm, setting.angle_rad});
    plant::ViewOptions options;
    options.light = setting.light;
    const plant::PlateView view(camera, plate, options, setting.deviation);
    std::vector<TagAppearance> seen;
    for (int frame = 0; frame < frames; ++frame)
        seen.push_back(
            tag_appearance(view.expose([&](double after_s) { return setting.speed_mm_per_s * after_s; },
                                       static_cast<std::uint64_t>(frame)),
                           detection_of(setting, camera)));
    return seen;
}

/// Mean and scatter of a value over frames.
struct Spread {
    double mean = 0.0, deviation = 0.0;
};

template <class Value>
Spread spread_of(const std::vector<TagAppearance>& seen, const Value& value) {
    Spread spread;
    for (const TagAppearance& one : seen) spread.mean += value(one) / static_cast<double>(seen.size());
    for (const TagAppearance& one : seen)
        spread.deviation += std::pow(value(one) - spread.mean, 2) / static_cast<double>(seen.size() - 1);
    spread.deviation = std::sqrt(spread.deviation);
    return spread;
}

/// All sides of a setting whose variance is known, within 1.5 % + 0.006 px^2 and the mean's own noise.
void expect_variances(const Setting& setting, const std::string& what) {
    constexpr int frames = 8;
    const CameraParameters camera = reference_camera();
    const std::vector<TagAppearance> seen = appearances(setting, frames);
    const double exposure_s = camera.exposure_s + setting.deviation.extra_exposure_s;
    const double way_px = setting.speed_mm_per_s * exposure_s / 0.004;
    for (std::size_t k = 0; k < 4; ++k) {
        const Spread variance =
            spread_of(seen, [&](const TagAppearance& one) { return one.sides[k].variance_px2; });
        const Eigen::Vector2d normal = seen.front().sides[k].normal;
        const double expected = std::pow(camera.blur_px, 2) + std::pow(setting.deviation.extra_blur_px, 2) +
                                pixel_variance + std::pow(way_px * normal.x(), 2) / 12.0;
        const double claimed = seen.front().sides[k].variance_std_px2;
        EXPECT_NEAR(variance.mean, expected, 0.006 + 0.015 * expected + 3.0 * claimed / std::sqrt(frames))
            << what << ", side " << k << ", claimed " << claimed << ", scatter " << variance.deviation;
        EXPECT_NEAR(normal.norm(), 1.0, 1e-9);
    }
}

TEST(SlowTagAppearance, Blur_IsTheEdgesVariance) {
    for (const double blur_px : {0.0, 0.3, 1.0, 2.0, 3.5})
        for (const double angle_rad : {0.0, 0.012, 0.4, 0.78})
            expect_variances({.deviation = {.extra_blur_px = blur_px}, .angle_rad = angle_rad},
                             "blur " + std::to_string(blur_px) + " angle " + std::to_string(angle_rad));
}

TEST(SlowTagAppearance, Motion_WidensTheEdgesAcrossIt) {
    for (const double speed_mm_per_s : {2.0, 5.0, 10.0})
        for (const double extra_s : {0.0, 0.002})
            for (const double angle_rad : {0.0, 0.3})
                expect_variances(
                    {.deviation = {.extra_exposure_s = extra_s},
                     .angle_rad = angle_rad,
                     .speed_mm_per_s = speed_mm_per_s},
                    "speed " + std::to_string(speed_mm_per_s) + " extra " + std::to_string(extra_s));
}

TEST(SlowTagAppearance, StatedScatter_IsWhatRepeatedFramesShow) {
    constexpr int frames = 60;
    for (const double read_noise_e : {0.0, 100.0}) {
        const std::vector<TagAppearance> seen =
            appearances({.deviation = {.extra_read_noise_e = read_noise_e}}, frames);
        const auto expect_scatter = [&](const char* what, const auto& value, const auto& claimed) {
            EXPECT_NEAR(spread_of(seen, value).deviation / spread_of(seen, claimed).mean, 1.0, 0.4) << what;
        };
        for (std::size_t k = 0; k < 4; ++k) {
            expect_scatter(
                "variance", [=](const TagAppearance& one) { return one.sides[k].variance_px2; },
                [=](const TagAppearance& one) { return one.sides[k].variance_std_px2; });
            expect_scatter(
                "white", [=](const TagAppearance& one) { return one.sides[k].white_grey; },
                [=](const TagAppearance& one) { return one.sides[k].white_std_grey; });
        }
        expect_scatter(
            "noise of white", [](const TagAppearance& one) { return std::log(one.white.variance_grey2); },
            [](const TagAppearance& one) { return one.white.std_share; });
        expect_scatter(
            "noise of black", [](const TagAppearance& one) { return std::log(one.black.variance_grey2); },
            [](const TagAppearance& one) { return one.black.std_share; });
    }
}

TEST(SlowTagAppearance, Noise_IsThatOfSensorAndRounding) {
    constexpr int frames = 10;
    const CameraParameters camera = reference_camera();
    const double grey_per_e = 255.0 / camera.full_well_e;
    for (const double read_noise_e : {0.0, 20.0, 60.0, 150.0})
        for (const double spread : {0.0, 0.01}) {
            const std::vector<TagAppearance> seen = appearances(
                {.deviation = {.extra_read_noise_e = read_noise_e, .gain_spread = spread}}, frames);
            for (GreyNoiseSeen TagAppearance::*colour : {&TagAppearance::white, &TagAppearance::black}) {
                const double grey =
                    spread_of(seen, [&](const TagAppearance& one) { return (one.*colour).grey; }).mean;
                const double variance = spread_of(seen, [&](const TagAppearance& one) {
                                            return (one.*colour).variance_grey2;
                                        }).mean;
                const double read_e = std::hypot(camera.read_noise_e, read_noise_e);
                const double expected = grey_per_e * grey + std::pow(grey_per_e * read_e, 2) +
                                        std::pow(spread * grey, 2) + 1.0 / 12.0;
                EXPECT_NEAR(variance / expected, 1.0, 0.04)
                    << read_noise_e << " e, " << spread << ", " << grey;
            }
        }
}

TEST(TagAppearance, White_IsTheLightBesideTheTag) {
    for (const double x_mm : {-1.2, 0.0, 1.2}) {
        const Setting setting{
            .deviation = {.light_gradient = {-0.2, 0.1}, .vignetting = 0.3}, .light = {}, .x_mm = x_mm};
        const std::vector<TagAppearance> seen = appearances(setting, 4);
        for (std::size_t k = 0; k < 4; ++k) {
            const Eigen::Vector2d middle_px = seen.front().sides[k].strip_px,
                                  half_px = seen.front().sides[k].half_strip_px;
            double expected = 0.0;
            for (const double share : {-1.0, 1.0}) {  // Gauss's two points
                const Eigen::Vector2d place_px = middle_px + share / std::sqrt(3.0) * half_px;
                const Eigen::Vector2d place((place_px.x() - 639.5) / 639.5, (place_px.y() - 479.5) / 479.5);
                expected += 0.5 * 0.9 * 255.0 * (1.0 + place.dot(Eigen::Vector2d(0.08 - 0.2, -0.03 + 0.1))) *
                            (1.0 - 0.5 * (0.06 + 0.3) * place.squaredNorm());
            }
            const Spread white =
                spread_of(seen, [&](const TagAppearance& one) { return one.sides[k].white_grey; });
            EXPECT_NEAR(white.mean / expected, 1.0, 1e-3) << x_mm << ", side " << k;
        }
    }
}

TEST(TagAppearance, CornersOffByAPixel_ChangeNothing) {
    constexpr int frames = 8;
    const CameraParameters camera = reference_camera();
    Plate plate;
    plate.tags.push_back({7, {0.0, 0.0}, side_mm, 0.1});
    const plant::PlateView view(camera, plate, {});
    const TagDetection exact = detection_of({.deviation = {}, .angle_rad = 0.1}, camera);
    TagDetection off = exact;
    off.corners_px[0] += Eigen::Vector2d(0.8, -0.7);
    off.corners_px[2] += Eigen::Vector2d(-0.6, 0.9);
    for (std::size_t k = 0; k < 4; ++k) {
        double difference = 0.0;
        for (std::uint64_t frame = 0; frame < frames; ++frame) {
            const cv::Mat image = view.render(std::vector<double>{0.0}, frame);
            difference += (tag_appearance(image, off).sides[k].variance_px2 -
                           tag_appearance(image, exact).sides[k].variance_px2) /
                          frames;
        }
        EXPECT_NEAR(difference, 0.0, 0.015) << "side " << k;
    }
}

TEST(TagAppearance, WhatCannotBeMeasured_IsSaid) {
    const TagAppearance blurred = appearances({.deviation = {.extra_blur_px = 7.0}}, 2).front();
    for (const TagSide& side : blurred.sides) EXPECT_TRUE(std::isnan(side.variance_px2));
    const TagAppearance bright = appearances({.deviation = {}, .light = {.level = 1.3}}, 2).front();
    for (const TagSide& side : bright.sides) {
        EXPECT_TRUE(std::isnan(side.white_grey));
        EXPECT_TRUE(std::isnan(side.variance_px2));
    }
    EXPECT_TRUE(std::isnan(bright.white.variance_grey2));
    EXPECT_NEAR(bright.black.grey, 1.3 * 25.5, 2.0);
    const TagAppearance outside = appearances({.deviation = {}, .x_mm = 2.6}, 2).front();
    EXPECT_TRUE(std::isnan(outside.sides[1].variance_px2));
}

}  // namespace
}  // namespace fidservo::vision
