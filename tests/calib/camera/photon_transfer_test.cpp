// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/photon_transfer.h"

#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::calib {
namespace {

struct Camera {
    double full_well_e = 10000.0;
    double read_noise_e = 5.0;
    double gain_spread = 0.0;
};

/// A burst of a wedge from dark to bright with a black bar across it; `flicker` is the lamp's from frame to
/// frame.
std::vector<cv::Mat> wedge(const Camera& camera, int frames, std::uint64_t seed, double flicker = 0.0) {
    constexpr int width = 480, height = 320;
    NoiseStream noise(seed, "pixels"), pattern(seed, "gains");
    cv::Mat level(height, width, CV_64F);
    for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
            const double scene = v > 150 && v < 170 ? 25.3 : 15.0 + 215.0 * u / width;
            level.at<double>(v, u) = scene * (1.0 + camera.gain_spread * pattern.normal());
        }
    const double gain = 255.0 / camera.full_well_e;
    std::vector<cv::Mat> burst;
    for (int k = 0; k < frames; ++k) {
        cv::Mat frame(height, width, CV_8UC1);
        const double light = 1.0 + (k % 2 == 0 ? flicker : -flicker);
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u) {
                const double mean = light * level.at<double>(v, u);
                const double std = std::sqrt(gain * mean + std::pow(gain * camera.read_noise_e, 2));
                frame.at<unsigned char>(v, u) = static_cast<unsigned char>(
                    std::clamp(std::lround(mean + std * noise.normal()), 0L, 255L));
            }
        burst.push_back(frame);
    }
    return burst;
}

TEST(SlowPhotonTransfer, OfAKnownCamera_IsItsNoiseWithinItsErrors) {
    for (const Camera& camera :
         {Camera{10000.0, 5.0, 0.0}, Camera{10000.0, 40.0, 0.01}, Camera{3000.0, 12.0, 0.004}}) {
        constexpr int seeds = 6;
        double well = 0.0, read = 0.0, spread = 0.0, misfit = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const auto found = measure_noise({wedge(camera, 6, static_cast<std::uint64_t>(seed))});
            ASSERT_TRUE(found) << found.error().text;
            well += std::pow((found->full_well_e - camera.full_well_e) / found->full_well_std_e, 2) / seeds;
            read +=
                std::pow((found->read_noise_e - camera.read_noise_e) / found->read_noise_std_e, 2) / seeds;
            spread += std::pow((found->gain_spread - camera.gain_spread) / found->gain_spread_std, 2) / seeds;
            misfit += found->misfit / seeds;
            EXPECT_LT(found->full_well_std_e, 0.02 * camera.full_well_e) << "seed " << seed;
        }
        std::printf(
            "full well %g e, read noise %g e, spread %g: mean squares in their variances %.2f %.2f %.2f, "
            "misfit %.2f\n",
            camera.full_well_e, camera.read_noise_e, camera.gain_spread, well, read, spread, misfit);
        const double most = 1.0 + 4.0 * std::sqrt(2.0 / seeds);
        EXPECT_LT(well, most);
        EXPECT_LT(read, most);
        EXPECT_LT(spread, most);
        EXPECT_NEAR(misfit, 1.0, 0.4);
    }
}

TEST(PhotonTransfer, FlickeringLamp_AddsNothing) {
    const Camera camera;
    const auto steady = measure_noise({wedge(camera, 6, 5)});
    const auto flickering = measure_noise({wedge(camera, 6, 5, 0.01)});
    ASSERT_TRUE(steady && flickering);
    EXPECT_NEAR(flickering->full_well_e, steady->full_well_e, 2.0 * steady->full_well_std_e);
}

TEST(PhotonTransfer, OneGreyLevel_IsRefused) {
    const cv::Mat grey(300, 400, CV_8UC1, cv::Scalar(120));
    std::vector<cv::Mat> burst;
    NoiseStream noise(1, "pixels");
    for (int k = 0; k < 4; ++k) {
        burst.push_back(grey.clone());
        burst.back().forEach<unsigned char>([&](unsigned char& g, const int*) {
            g = static_cast<unsigned char>(std::lround(120.0 + 2.0 * noise.normal()));
        });
    }
    EXPECT_FALSE(measure_noise({burst}));
    EXPECT_FALSE(measure_noise({{grey}}));
    EXPECT_FALSE(measure_noise({}));
}

}  // namespace
}  // namespace fidservo::calib
