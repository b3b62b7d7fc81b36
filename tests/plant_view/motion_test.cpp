// SPDX-License-Identifier: GPL-3.0-or-later
// Motion during the exposure.
#include "plant/view/edge_profile.h"
#include "plant/view/motion_blur.h"
#include "tests/plant_view/view_fixture.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::plant {
namespace {

/// Things of every kind, some across the image's border, in a quarter of the reference image.
PlateView busy_view(ViewOptions options) {
    Plate plate;
    plate.tags.push_back({.id = 5, .centre_mm = {-0.2, 0.0}, .side_mm = 1.2, .angle_rad = 0.0122});
    plate.features.push_back({"dot", Dot{{0.7, 0.2}, 0.3}, 0.1});
    plate.features.push_back({"line", Line{{0.4, -0.4}, {1.5, -0.3}, 0.04}, 0.1});
    plate.features.push_back({"pad", Pad{{-0.9, 0.3}, {0.4, 0.2}, 0.2}, 0.3});
    plate.features.push_back({"scratch", Scratch{{{-0.8, -0.5}, {0.0, 0.5}, {0.9, 0.1}}, 0.02}, 0.7});
    options.glare.push_back({{0.3, -0.5}, 0.05, 0.05});
    return {small_camera(480, 320), plate, options};
}

std::vector<double> samples_of(int count, const std::function<double(double)>& s_mm) {
    std::vector<double> samples;
    samples.reserve(count);
    for (int k = 0; k < count; ++k) samples.push_back(s_mm(k / (count - 1.0)));
    return samples;
}

/// The mean of many images at rest, at evenly spaced times over the exposure.
cv::Mat mean_of_images(const PlateView& view, const std::function<double(double)>& s_mm) {
    constexpr int images = 200;
    cv::Mat sum;
    for (int k = 0; k < images; ++k) {
        cv::Mat image;
        render_at(view, s_mm((k + 0.5) / images)).convertTo(image, CV_64F);
        sum = sum.empty() ? image : cv::Mat(sum + image);
    }
    return sum / images;
}

double worst_difference(const cv::Mat& image, const cv::Mat& mean) {
    double worst = 0.0;
    for (int v = 0; v < image.rows; ++v) {
        for (int u = 0; u < image.cols; ++u) {
            worst = std::max(worst, std::abs(image.at<std::uint8_t>(v, u) - mean.at<double>(v, u)));
        }
    }
    return worst;
}

// Half a grey level of rounding on either side, and 0.1 % of 204 grey levels of contrast for the
// interpolation.
constexpr double motion_tolerance_grey = 0.5 + 0.5 + 0.2;

TEST(SlowPlateView, EvenMotion_IsTheMeanOfImagesAlongTheWay) {
    const PlateView view = busy_view(ideal_view());
    for (const double travel_mm : {0.0003, 0.003, 0.02, 0.2}) {
        const auto motion = [&](double t) { return 0.0011 + travel_mm * t; };
        const cv::Mat moving = view.render(samples_of(2, motion), 0);
        EXPECT_LT(worst_difference(moving, mean_of_images(view, motion)), motion_tolerance_grey)
            << travel_mm << " mm";
    }
}

TEST(PlateView, UnevenMotion_IsTheMeanOfImagesAlongTheWay) {
    const PlateView view = busy_view(ideal_view());
    const auto ringing = [](double t) { return 0.01 * t * t + 0.006 * std::sin(9.0 * t); };
    const cv::Mat moving = view.render(samples_of(41, ringing), 0);
    EXPECT_LT(worst_difference(moving, mean_of_images(view, ringing)), motion_tolerance_grey);
}

TEST(PlateView, ManySamplesAtRest_GiveTheSameImageAsOne) {
    const PlateView view = busy_view({});
    const cv::Mat one = render_at(view, 0.0123, 4);
    const cv::Mat many = view.render(std::vector<double>(21, 0.0123), 4);
    EXPECT_EQ(cv::norm(one, many, cv::NORM_INF), 0.0);
}

TEST(MotionKernel, OfARamp_ShiftsItByTheMeanOfTheMotion) {
    const std::vector<double> shifts = {-1.3, 0.4, 2.0};  // mean over the exposure 0.375
    const view::MotionKernel kernel(shifts);
    std::vector<float> ramp(40 + 2 * kernel.reach()), blurred(40);
    for (std::size_t i = 0; i < ramp.size(); ++i)
        ramp[i] = static_cast<float>(i) - static_cast<float>(kernel.reach());
    kernel.apply(ramp, blurred);
    for (int i = 0; i < 40; ++i) EXPECT_NEAR(blurred[i], i - 0.375, 1e-4);
}

TEST(MotionKernel, OfABlurredEdgeInEvenMotion_IsItsMean) {
    const auto edge = view::EdgeProfile::of_pixel(0.8, 0.0);
    for (const double travel : {0.05, 0.3, 0.6, 0.9, 1.3, 2.0, 7.7}) {
        const view::MotionKernel kernel(std::vector<double>{-0.5 * travel, 0.5 * travel});
        double worst = 0.0;
        for (double place = 20.0; place < 21.0; place += 0.05) {
            std::vector<float> sharp(40 + 2 * kernel.reach()), blurred(40);
            for (std::size_t i = 0; i < sharp.size(); ++i) {
                sharp[i] = static_cast<float>(edge(static_cast<double>(i) - kernel.reach() - place));
            }
            kernel.apply(sharp, blurred);
            for (int i = 0; i < 40; ++i) {
                double mean = 0.0;
                constexpr int parts = 200;
                for (int k = 0; k < parts; ++k) mean += edge(i - place + travel * ((k + 0.5) / parts - 0.5));
                worst = std::max(worst, std::abs(blurred[i] - mean / parts));
            }
        }
        EXPECT_LT(worst, 2e-3) << travel << " px";
    }
}

TEST(MotionKernel, BelowWhatCanBeSeen_IsNone) {
    EXPECT_TRUE(view::MotionKernel(std::vector<double>{0.0}).is_identity());
    EXPECT_TRUE(view::MotionKernel(std::vector<double>{-0.005, 0.005}).is_identity());
    EXPECT_FALSE(view::MotionKernel(std::vector<double>{-0.05, 0.05}).is_identity());
}

TEST(MeanPosition, IsTheTimeAverageOfTheStraightPieces) {
    EXPECT_DOUBLE_EQ(view::mean_position(std::vector<double>{3.0}), 3.0);
    EXPECT_DOUBLE_EQ(view::mean_position(std::vector<double>{1.0, 2.0, 7.0}), 0.5 * (1.5 + 4.5));
}

}  // namespace
}  // namespace fidservo::plant
