// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/sensor.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::precision {
namespace {

struct Moments {
    double mean, variance;
};

Moments moments_of(const Sensor& sensor, double share) {
    const cv::Mat1d even(400, 400, share);
    const FrameSource source(sensor, even);
    NoiseStream noise(1, "sensor");
    double sum = 0.0, squares = 0.0, count = 0.0;
    cv::Mat1b frame;
    for (int k = 0; k < 4; ++k) {
        source.draw(noise, frame, {0, 0, 400, 400});
        for (const unsigned char grey : frame) {
            sum += grey;
            squares += grey * grey;
            count += 1.0;
        }
    }
    return {sum / count, squares / count - std::pow(sum / count, 2)};
}

TEST(Sensor, EvenLight_HasTheMeanAndVarianceOfItsModel) {
    for (const Sensor sensor : {Sensor{}, Sensor{1000.0}, Sensor{.gain_spread = 0.01}, Sensor{.gamma = 2.2},
                                Sensor{.gamma = 2.2, .noise_after_gamma = true}})
        for (const double share : {0.13, 0.5, 0.76}) {
            const Moments seen = moments_of(sensor, share);
            const double expected = grey_variance(sensor, share);
            // 640,000 pixels: five standard deviations; curved responses shift both by a little more.
            const double slack = sensor.gamma == 1.0 ? 0.0 : 0.01;
            EXPECT_NEAR(seen.mean, grey_of(sensor, share), 5.0 * std::sqrt(expected / 640000) + slack)
                << share;
            EXPECT_NEAR(seen.variance / expected, 1.0, 5.0 * std::sqrt(2.0 / 640000) + slack) << share;
        }
}

TEST(Sensor, RegionDrawnAnew_LeavesTheRest) {
    const FrameSource source({}, cv::Mat1d(20, 20, 0.5));
    NoiseStream noise(2, "sensor");
    cv::Mat1b frame;
    source.draw(noise, frame, {});
    const cv::Mat1b before = frame.clone();
    source.draw(noise, frame, {5, 6, 7, 8});
    int changed = 0;
    for (int v = 0; v < 20; ++v)
        for (int u = 0; u < 20; ++u) {
            const bool inside = cv::Rect(5, 6, 7, 8).contains({u, v});
            changed += frame(v, u) != before(v, u) ? 1 : 0;
            if (!inside) {
                EXPECT_EQ(frame(v, u), before(v, u));
            }
        }
    EXPECT_GT(changed, 30);
}

TEST(Sensor, TooMuchLight_IsWhite) {
    const FrameSource source({}, cv::Mat1d(1, 8, 2.0));
    NoiseStream noise(3, "sensor");
    cv::Mat1b frame;
    source.draw(noise, frame, {});
    for (const unsigned char grey : frame) EXPECT_EQ(grey, 255);
}

}  // namespace
}  // namespace fidservo::precision
