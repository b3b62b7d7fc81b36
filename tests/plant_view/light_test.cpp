// SPDX-License-Identifier: GPL-3.0-or-later
// Light, pixel gains, glare, and what lies on the plate.
#include "tests/plant_view/view_fixture.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::plant {
namespace {

TEST(PlateView, UnevenLight_FollowsItsFormula) {
    Plate plate;
    plate.paper_reflectance = 0.5;
    ViewOptions options = ideal_view();
    options.light = {.level = 0.9, .gradient = {0.10, -0.05}, .vignetting = 0.2};
    const cv::Mat image = render_at(PlateView(small_camera(641, 481), plate, options), 0.0);
    const auto expect_grey = [&](int u, int v, double x, double y) {
        const double expected =
            127.5 * 0.9 * (1.0 + 0.10 * x - 0.05 * y) * (1.0 - 0.2 * (x * x + y * y) / 2.0);
        EXPECT_NEAR(image.at<std::uint8_t>(v, u), expected, 0.51) << u << ' ' << v;
    };
    expect_grey(320, 240, 0.0, 0.0);
    expect_grey(0, 0, -1.0, -1.0);
    expect_grey(640, 480, 1.0, 1.0);
    expect_grey(480, 120, 0.5, -0.5);
}

TEST(PlateView, PixelGains_AreFixedAndHaveTheirSpread) {
    Plate plate;
    plate.paper_reflectance = 0.5;
    ViewOptions options = ideal_view();
    options.pixel_gain_spread = 0.05;
    const PlateView view(small_camera(320, 240), plate, options);
    const cv::Mat image = render_at(view, 0.0, 1);
    EXPECT_EQ(cv::norm(image, render_at(view, 1.0, 2), cv::NORM_INF), 0.0);
    cv::Scalar mean, deviation;
    cv::meanStdDev(image, mean, deviation);
    const double sigma = 127.5 * 0.05, pixels = 320.0 * 240.0;
    EXPECT_NEAR(mean[0], 127.5, 4.5 * sigma / std::sqrt(pixels));
    EXPECT_NEAR(deviation[0], std::hypot(sigma, std::sqrt(1.0 / 12.0)),
                4.5 * sigma / std::sqrt(2.0 * pixels));
}

TEST(PlateView, Glare_SaturatesAtItsPlaceOnThePlate) {
    ViewOptions options = ideal_view();
    options.glare.push_back({.centre_mm = {1.0, 0.2}, .radius_mm = 0.05, .strength = 3.0});
    const PlateView view(reference_camera(), {}, options);
    const cv::Mat image = render_at(view, 0.6);
    // 0.9 + 3 exp(-r^2 / 2 w^2) = 1 at r = 2.608 w = 32.6 px from (639.5 + 100, 479.5 + 50).
    EXPECT_EQ(image.at<std::uint8_t>(530, 740), 255);
    EXPECT_EQ(image.at<std::uint8_t>(530, 740 + 31), 255);
    EXPECT_LT(image.at<std::uint8_t>(530, 740 + 36), 250);
    EXPECT_EQ(image.at<std::uint8_t>(100, 100), 230);
}

TEST(PlateView, Occluder_HidesWhatIsPrintedBelow) {
    Plate plate;
    plate.tags.push_back({.id = 0, .centre_mm = {0.0, 0.0}, .side_mm = 1.2});
    plate.features.push_back({"dot", Dot{{0.0, 0.0}, 0.3}, 0.2});
    ViewOptions options = ideal_view();
    options.occluders.push_back({"hair", Pad{{0.0, 0.0}, {0.8, 0.4}}, 0.4});
    const cv::Mat image = render_at(PlateView(reference_camera(), plate, options), 0.0);
    const cv::Mat inside = image(cv::Rect(640 - 90, 480 - 40, 180, 80));
    EXPECT_EQ(cv::countNonZero(inside != 102), 0);
    EXPECT_EQ(image.at<std::uint8_t>(480, 640 - 140), 26);  // the tag's border: ink
}

TEST(PlateView, Features_LieOverEachOtherInTheirOrder) {
    Plate plate;
    plate.features.push_back({"below", Pad{{0.0, 0.0}, {1.0, 1.0}}, 0.2});
    plate.features.push_back({"above", Dot{{0.0, 0.0}, 0.4}, 0.8});
    const cv::Mat image = render_at(PlateView(reference_camera(), plate, ideal_view()), 0.0);
    EXPECT_EQ(image.at<std::uint8_t>(480, 640), 204);
    EXPECT_EQ(image.at<std::uint8_t>(480, 640 + 100), 51);
    EXPECT_EQ(image.at<std::uint8_t>(480, 640 + 200), 230);
}

TEST(PlateView, Blur_IsTheOptionsInPlaceOfTheCameras) {
    Plate plate = dark_plate();
    plate.features.push_back({"edge", Pad{{1.0, 0.0}, {2.0, 4.0}}, 1.0});
    ViewOptions options = ideal_view();
    options.blur_px = 3.0;
    const cv::Mat image = render_at(PlateView(small_camera(201, 101), plate, options), 0.0);
    // Phi(3 / 3) = 0.8413; the pixel's box changes the third digit.
    EXPECT_NEAR(image.at<std::uint8_t>(50, 103), 255 * 0.8402, 1.0);
    EXPECT_NEAR(image.at<std::uint8_t>(50, 97), 255 * 0.1598, 1.0);
}

}  // namespace
}  // namespace fidservo::plant
