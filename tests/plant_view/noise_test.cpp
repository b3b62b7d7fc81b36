// SPDX-License-Identifier: GPL-3.0-or-later
// Noise: the moments that the sensor's data sheet states, without repetition.
#include "core/random.h"
#include "plant/view/sensor.h"
#include "tests/plant_view/view_fixture.h"

#include <numeric>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::plant {
namespace {

/// A plate of uniform grey under uniform light, so that every pixel has the same mean.
PlateView grey_view(double reflectance, int width_px, int height_px, std::uint64_t seed) {
    Plate plate;
    plate.paper_reflectance = reflectance;
    ViewOptions options = ideal_view();
    options.noise = true;
    options.seed = seed;
    return {small_camera(width_px, height_px), plate, options};
}

cv::Mat noise_of(const PlateView& view, std::uint64_t frame) {
    cv::Mat image;
    render_at(view, 0.0, frame).convertTo(image, CV_64F);
    return image - cv::mean(image)[0];
}

/// Correlation of a with b moved by (du, dv), of zero-mean images; standard error 1 / sqrt(pixels).
double correlation(const cv::Mat& a, const cv::Mat& b, int du, int dv) {
    const cv::Rect there(du, dv, a.cols - du, a.rows - dv), here(0, 0, a.cols - du, a.rows - dv);
    return a(here).dot(b(there)) / std::sqrt(a(here).dot(a(here)) * b(there).dot(b(there)));
}

TEST(PlateView, SameSeedAndFrame_SameBytes_OthersDiffer) {
    const PlateView view = grey_view(0.5, 320, 200, 1);
    const cv::Mat image = render_at(view, 0.0, 10);
    EXPECT_EQ(cv::norm(image, render_at(grey_view(0.5, 320, 200, 1), 0.0, 10), cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(image, render_at(view, 0.0, 11), cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(image, render_at(grey_view(0.5, 320, 200, 2), 0.0, 10), cv::NORM_INF), 0.0);
}

TEST(PlateView, PhotonTransfer_VarianceIsShotAndReadNoiseAndRoundingAtEveryGreyLevel) {
    const double grey_per_e = 255.0 / 10000.0;
    double sum_mean = 0, sum_variance = 0, sum_product = 0, sum_square = 0;
    int levels = 0;
    for (double reflectance = 0.05; reflectance < 0.95; reflectance += 0.0731, ++levels) {
        const PlateView view = grey_view(reflectance, 512, 512, 21);
        cv::Scalar mean, deviation;
        cv::meanStdDev(render_at(view, 0.0), mean, deviation);
        const double pixels = 512.0 * 512.0, variance = deviation[0] * deviation[0];
        const double expected_mean = 255.0 * reflectance;
        const double expected = grey_per_e * expected_mean + std::pow(5.0 * grey_per_e, 2) + 1.0 / 12.0;
        EXPECT_NEAR(mean[0], expected_mean, 4.5 * std::sqrt(expected / pixels)) << reflectance;
        // Rounding adds 1/12 to 0.5 % only at the 0.6 grey levels of noise in the darkest of these.
        EXPECT_NEAR(variance, expected, expected * 4.5 * std::sqrt(2.0 / pixels) + 0.001) << reflectance;
        sum_mean += mean[0];
        sum_variance += variance;
        sum_product += mean[0] * variance;
        sum_square += mean[0] * mean[0];
    }
    const double slope =
        (levels * sum_product - sum_mean * sum_variance) / (levels * sum_square - sum_mean * sum_mean);
    EXPECT_NEAR(slope, grey_per_e, 0.005 * grey_per_e);
}

TEST(PlateView, Saturation_ClipsAtWhite) {
    const cv::Mat image = render_at(grey_view(1.2, 64, 64, 1), 0.0);
    EXPECT_EQ(cv::countNonZero(image != 255), 0);
}

TEST(PlateView, Noise_IsNotCorrelatedBetweenPixelsNorFrames) {
    const PlateView view = grey_view(0.5, 1280, 960, 33);
    const cv::Mat first = noise_of(view, 100), next = noise_of(view, 101);
    const double limit = 4.8 / std::sqrt(1280.0 * 960.0);  // 1e-6 of all draws lie beyond
    for (int dv = 0; dv <= 4; ++dv) {
        for (int du = 0; du <= 20; ++du) {
            if (du + dv > 0) {
                EXPECT_LT(std::abs(correlation(first, first, du, dv)), limit) << du << ' ' << dv;
            }
            EXPECT_LT(std::abs(correlation(first, next, du, dv)), limit) << du << ' ' << dv;
        }
    }
}

TEST(PlateView, Noise_NoRowRepeatsAnother) {
    const cv::Mat noise = noise_of(grey_view(0.5, 1280, 400, 34), 0);
    double worst = 0.0;
    for (int a = 0; a < noise.rows; ++a) {
        for (int b = a + 1; b < noise.rows; ++b) {
            worst = std::max(worst, std::abs(correlation(noise.row(a), noise.row(b), 0, 0)));
        }
    }
    EXPECT_LT(worst, 6.2 / std::sqrt(1280.0));  // 80,000 pairs
}

TEST(NormalRow, HasTheMomentsAndTailsOfTheNormalLaw) {
    const view::NormalRow row;
    NoiseStream stream(5, "normal_row");
    constexpr int rows = 2000, width = 1283;  // not a multiple of the lanes
    std::vector<float> normals(width);
    std::array<double, 5> moments{};
    int beyond_3 = 0, beyond_4 = 0;
    for (int k = 0; k < rows; ++k) {
        row.fill(stream, normals);
        for (const double z : normals) {
            for (int power = 1; power <= 4; ++power) moments[power] += std::pow(z, power);
            beyond_3 += std::abs(z) > 3.0;
            beyond_4 += std::abs(z) > 4.0;
        }
    }
    constexpr double n = static_cast<double>(rows) * width;
    const double sigma = 1.0 / std::sqrt(n);
    EXPECT_NEAR(moments[1] / n, 0.0, 4.5 * sigma);
    EXPECT_NEAR(moments[2] / n, 1.0, 4.5 * std::sqrt(2.0) * sigma);
    EXPECT_NEAR(moments[3] / n, 0.0, 4.5 * std::sqrt(15.0) * sigma);
    EXPECT_NEAR(moments[4] / n, 3.0, 4.5 * std::sqrt(96.0) * sigma);
    EXPECT_NEAR(beyond_3, n * 2.700e-3, 4.5 * std::sqrt(n * 2.700e-3) + n * 2.7e-5);
    EXPECT_NEAR(beyond_4, n * 6.334e-5, 4.5 * std::sqrt(n * 6.334e-5) + n * 2e-6);
}

}  // namespace
}  // namespace fidservo::plant
