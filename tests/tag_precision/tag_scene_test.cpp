// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/tag_scene.h"

#include "vision/tags/tag_detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::precision {
namespace {

double ramp(double x, double sigma) {
    const double z = x / sigma;
    return x * 0.5 * std::erfc(-z / std::numbers::sqrt2) +
           sigma * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

/// Share of the blurred interval low..high that falls into the pixel at u: products of it are upright
/// rectangles.
double interval_share(int u, double low, double high, double sigma) {
    return ramp(u + 0.5 - low, sigma) - ramp(u - 0.5 - low, sigma) - ramp(u + 0.5 - high, sigma) +
           ramp(u - 0.5 - high, sigma);
}

TEST(BlurredRegion, UprightRectangle_IsAProductOfIntegralsOfTheNormalDistribution) {
    for (const double sigma : {0.3, 0.8, 3.0}) {
        const double left = 12.3, right = 27.91, top = 9.87, bottom = 30.02;
        const cv::Mat1d seen = coverage(
            edges_of({{left, top}, {right, top}, {right, bottom}, {left, bottom}}), {sigma}, {40, 40});
        for (int v = 0; v < seen.rows; ++v)
            for (int u = 0; u < seen.cols; ++u)
                EXPECT_NEAR(seen(v, u),
                            interval_share(u, left, right, sigma) * interval_share(v, top, bottom, sigma),
                            1e-6)
                    << sigma << " at " << u << ", " << v;
    }
}

TEST(BlurredRegion, MotionAlongU_IsTheMeanOfPicturesAlongTheWay) {
    const auto shifted = [](double du) {
        return edges_of({{10.2 + du, 8.1}, {26.4 + du, 11.7}, {22.9 + du, 27.3}, {9.1 + du, 20.6}});
    };
    constexpr int stops = 400;
    const double motion = 5.0;
    cv::Mat1d mean(36, 40, 0.0);
    for (int k = 0; k < stops; ++k)
        mean += coverage(shifted(motion * ((k + 0.5) / stops - 0.5)), {0.8}, mean.size()) / stops;
    const cv::Mat1d moved = coverage(shifted(0.0), {0.8, motion}, mean.size());
    EXPECT_LT(cv::norm(moved, mean, cv::NORM_INF), 2e-5);  // of the midpoint rule: h^2 / 24 max f''
}

/// Turning the plane about the middle of a blurred, not sampled, picture changes nothing: with pixels as
/// small as a tenth of the blur, the squares' directions do not matter any more.
TEST(BlurredRegion, TurnedRectangle_IsTheUprightOneSeenFromTheSide) {
    const double angle = 0.3, c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](double x, double y) {
        return Eigen::Vector2d(60 + c * x - s * y, 60 + s * x + c * y);
    };
    const cv::Mat1d seen = coverage(
        edges_of({turned(-25, -18), turned(25, -18), turned(25, 18), turned(-25, 18)}), {10.0}, {121, 121});
    const double pixel_sigma =
        std::sqrt(100.0 + 1.0 / 12.0);  // a square is a normal distribution to 4th order
    for (int v = 0; v < seen.rows; v += 3)
        for (int u = 0; u < seen.cols; u += 3) {
            const double x = c * (u - 60) + s * (v - 60), y = -s * (u - 60) + c * (v - 60);
            const auto share = [&](double at, double half) {
                return 0.5 * (std::erf((at + half) / pixel_sigma / std::numbers::sqrt2) -
                              std::erf((at - half) / pixel_sigma / std::numbers::sqrt2));
            };
            EXPECT_NEAR(seen(v, u), share(x, 25) * share(y, 18), 1e-6);
        }
}

/// A triangle cut into rows 1/512 px high, each a blurred interval.
TEST(BlurredRegion, Triangle_IsTheSumOfItsRows) {
    const std::vector<Eigen::Vector2d> corners{{4.3, 3.9}, {15.2, 7.4}, {7.7, 14.8}};
    constexpr double sigma = 0.8, height = 1.0 / 512;
    const cv::Mat1d seen = coverage(edges_of(corners), {sigma}, {20, 20});
    cv::Mat1d sum(20, 20, 0.0);
    for (double y = 3.9 + 0.5 * height; y < 14.8; y += height) {
        std::vector<double> crossings;
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector2d a = corners[k], b = corners[(k + 1) % 3];
            if ((a.y() < y) != (b.y() < y))
                crossings.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
        }
        ASSERT_EQ(crossings.size(), 2U);
        const auto [left, right] = std::minmax(crossings[0], crossings[1]);
        for (int v = 0; v < sum.rows; ++v)
            for (int u = 0; u < sum.cols; ++u)
                sum(v, u) += interval_share(u, left, right, sigma) *
                             interval_share(v, y - 0.5 * height, y + 0.5 * height, sigma);
    }
    EXPECT_LT(cv::norm(seen, sum, cv::NORM_INF), 1e-5);
}

TEST(TagScene, UprightTagWithSpreadInk_IsTheSumOfItsCells) {
    TagScene scene;
    scene.side_px = 160.0;
    scene.centre_px = {120.37, 110.81};
    scene.camera.width_px = 240;
    scene.camera.height_px = 220;
    const cv::Mat1d plain = ink_picture(scene);
    scene.ink_spread_px = 0.3;
    const cv::Mat1d grown = ink_picture(scene);
    double least = 1.0, most = 0.0;
    cv::minMaxLoc(grown, &least, &most);
    EXPECT_NEAR(least, 0.0, 1e-6);
    EXPECT_NEAR(most, 1.0, 1e-6);
    // The outer border of a black square of 160 px, grown, and blurred: row 110 far from its ends.
    for (int u = 30; u < 50; ++u) {
        EXPECT_NEAR(plain(110, u), interval_share(u, 40.37, 80.0, 0.8), 1e-6) << u;
        EXPECT_NEAR(grown(110, u), interval_share(u, 40.07, 80.0, 0.8), 1e-6) << u;
    }
}

TEST(TagScene, TiltedTag_IsReadWithItsCornersWhereTheyAre) {
    TagScene scene;
    scene.tag_id = 7;
    scene.angle_rad = 0.2;
    scene.camera.tilt_rad = {0.0, 0.3};
    cv::Mat1b image;
    cv::Mat(255.0 * mean_picture(scene)).convertTo(image, CV_8U);
    const auto found = vision::TagDetector().detect(image, 0);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].tag_id, 7);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_LT((found[0].corners_px[k] - corners_of(scene)[k]).norm(), 0.2) << k;
}

TEST(TagScene, LensThatDoesNotDistort_MakesTheSamePictureInManySteps) {
    TagScene scene;
    scene.angle_rad = 0.012;
    scene.camera.tilt_rad = {0.03, 0.08};
    const cv::Mat1d straight = mean_picture(scene);
    scene.camera.distortion.k1 = 1e-12;
    EXPECT_LT(cv::norm(straight, mean_picture(scene), cv::NORM_INF), 1e-7);
}

}  // namespace
}  // namespace fidservo::precision
