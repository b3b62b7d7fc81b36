// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/clock_fit.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::imports {
namespace {

using ::testing::HasSubstr;

/// A motion that does not repeat: the sum of three sines without a common period, beneath a hill.
double motion(double t_s) {
    return 3.0 * std::sin(2.1 * t_s) + std::sin(5.3 * t_s + 1.0) + 2.0 * std::sin(0.77 * t_s) +
           4.0 * std::exp(-0.5 * (t_s - 11.0) * (t_s - 11.0));
}

/// Samples of the motion by a clock: it shows t where the reference shows offset + t + rate (t - first).
MotionTrack track_on_clock(double first_s, double step_s, std::size_t count, double offset_s, double rate_ppm,
                           double scale, double noise, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> draw(0.0, noise);
    MotionTrack track;
    for (std::size_t k = 0; k < count; ++k) {
        const double t = first_s + static_cast<double>(k) * step_s;
        track.time_s.push_back(t);
        track.value.push_back(scale * motion(offset_s + t + 1e-6 * rate_ppm * (t - first_s)) +
                              draw(generator));
    }
    return track;
}

TEST(ClockFit, OffsetAndRate_AreFoundWithinTheirStds) {
    int outside = 0;
    constexpr int rounds = 20;
    for (unsigned seed = 1; seed <= rounds; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 generator(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        const double offset_s = 3.0 * unit(generator), rate_ppm = 300.0 * unit(generator);
        const MotionTrack reference = track_on_clock(0.0, 0.001, 20'000, 0.0, 0.0, 1.0, 0.01, 2 * seed);
        const MotionTrack track = track_on_clock(2.0 - 3.0 * offset_s / 3.0, 0.0167, 700, offset_s, rate_ppm,
                                                 -40.0, 2.0, 2 * seed + 1);
        const auto fit = fit_clock(track, reference);
        ASSERT_TRUE(fit) << fit.error();
        const double z = (fit->offset_s - offset_s) / fit->offset_std_s,
                     z_rate = (fit->rate_ppm - rate_ppm) / fit->rate_std_ppm;
        EXPECT_LT(std::abs(z), 5.0) << fit->offset_s << " for " << offset_s << ", std " << fit->offset_std_s;
        EXPECT_LT(std::abs(z_rate), 5.0)
            << fit->rate_ppm << " for " << rate_ppm << ", std " << fit->rate_std_ppm;
        EXPECT_LT(fit->correlation, -0.9) << "the track is mirrored";
        EXPECT_LT(fit->offset_std_s, 2e-3);
        outside += std::abs(z) > 2.0 || std::abs(z_rate) > 2.0;
    }
    // 1 in 11 by chance; 8 of 20 has a probability below 0.1 %.
    EXPECT_LE(outside, 7);
}

TEST(ClockFit, MotionThatRepeats_HasNoAnswer_WhateverItsNoise) {
    unsigned seed = 0;
    for (const double frequency_Hz : {0.25, 1.3, 2.0})
        for (const double noise : {0.0, 0.01, 0.3}) {
            SCOPED_TRACE(::testing::Message() << frequency_Hz << " Hz, noise " << noise);
            std::mt19937 generator(++seed);
            std::normal_distribution<double> draw;
            const auto sine = [&](double t_s) {
                return std::sin(2.0 * M_PI * frequency_Hz * t_s) + noise * draw(generator);
            };
            MotionTrack reference, track;
            for (int k = 0; k < 4000; ++k) {
                reference.time_s.push_back(0.005 * k);
                reference.value.push_back(sine(0.005 * k));
                track.time_s.push_back(0.005 * k);
                track.value.push_back(sine(0.005 * k - 0.1));
            }
            const auto fit = fit_clock(track, reference);
            ASSERT_FALSE(fit) << fit->offset_s;
            EXPECT_THAT(fit.error(), HasSubstr("the motion repeats"));
        }
}

/// Straight lines between random places half a second apart.
MotionTrack wandering(double length_s, double from_s, double noise, unsigned seed, unsigned noise_seed) {
    constexpr double knot_s = 0.5;
    std::mt19937 generator(seed), of_noise(noise_seed);
    std::normal_distribution<double> draw;
    std::vector<double> knots(static_cast<std::size_t>(length_s / knot_s) + 40);
    for (double& knot : knots) knot = draw(generator);
    MotionTrack track;
    for (int k = 0; 0.02 * k < length_s; ++k) {
        const double at = (0.02 * k + from_s) / knot_s, share = at - std::floor(at);
        const auto before = static_cast<std::size_t>(at);
        track.time_s.push_back(0.02 * k);
        track.value.push_back((1.0 - share) * knots[before] + share * knots[before + 1] +
                              noise * draw(of_noise));
    }
    return track;
}

TEST(ClockFit, MotionThatWanders_DoesNotRepeat) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(seed);
        const double noise = seed % 2 == 0 ? 0.02 : 0.3;
        const auto fit = fit_clock(wandering(60.0, 3.0, noise, seed, 2 * seed),
                                   wandering(60.0, 0.0, noise, seed, 2 * seed + 1));
        ASSERT_TRUE(fit) << fit.error();
        EXPECT_NEAR(fit->offset_s, 3.0, 5.0 * fit->offset_std_s);
        EXPECT_LT(fit->offset_std_s, 0.1 * noise);
    }
}

/// Steps at irregular times: few samples move, and these tell.
TEST(ClockFit, MotionInSharpSteps_TellsOffsetAndRate) {
    constexpr double offset_s = 0.25, rate_ppm = 100.0;
    const auto place = [](double t_s) {
        double sum = 0.0;
        for (const double at_s : {2.0, 4.5, 5.2, 9.0, 13.7, 15.1})
            sum += (at_s < 6.0 ? 1.0 : -1.0) * std::tanh((t_s - at_s) / 0.02);
        return 10.0 * sum;
    };
    std::mt19937 generator(3);
    std::normal_distribution<double> draw(0.0, 0.01);
    MotionTrack reference, track;
    for (int k = 0; k < 17'000; ++k) {
        reference.time_s.push_back(0.001 * k);
        reference.value.push_back(place(0.001 * k) + draw(generator));
    }
    for (int k = 0; k < 700; ++k) {
        const double t_s = 0.0227 * k;
        track.time_s.push_back(t_s);
        track.value.push_back(place(offset_s + t_s * (1.0 + 1e-6 * rate_ppm)) + draw(generator));
    }
    const auto fit = fit_clock(track, reference);
    ASSERT_TRUE(fit) << fit.error();
    EXPECT_NEAR(fit->offset_s, offset_s, 5.0 * fit->offset_std_s);
    EXPECT_NEAR(fit->rate_ppm, rate_ppm, 5.0 * fit->rate_std_ppm);
    EXPECT_LT(fit->offset_std_s, 0.001);
}

/// One step tells where the clocks stand in it, not how fast they run, however clear it is.
TEST(ClockFit, OneStep_DoesNotTellTheRate) {
    MotionTrack reference, track;
    for (int k = 0; k < 4000; ++k) {
        const auto step = [](double t_s) { return std::clamp(10.0 * (t_s - 5.0), 0.0, 1.0); };
        reference.time_s.push_back(0.005 * k);
        reference.value.push_back(step(0.005 * k));
        track.time_s.push_back(0.005 * k);
        track.value.push_back(step(0.005 * k - 0.1));
    }
    const auto fit = fit_clock(track, reference);
    ASSERT_FALSE(fit) << fit->rate_ppm << " ppm +- " << fit->rate_std_ppm;
    EXPECT_THAT(fit.error(), HasSubstr("does not determine the clock"));
}

/// One short pulse tells where the clocks stand in it, not how fast they run.
TEST(ClockFit, OffsetThatIsUncertainFarFromTheMotion_IsRefused) {
    std::mt19937 generator(1);
    std::normal_distribution<double> draw;
    const auto pulse = [&](double t_s) {
        return std::exp(-0.5 * std::pow((t_s - 50.0) / 0.1, 2)) + 0.1 * draw(generator);
    };
    MotionTrack reference, track;
    for (int k = 0; k < 10'000; ++k) {
        reference.time_s.push_back(0.01 * k);
        reference.value.push_back(pulse(0.01 * k));
        track.time_s.push_back(0.01 * k);
        track.value.push_back(pulse(0.01 * k));
    }
    const auto fit = fit_clock(track, reference);
    ASSERT_FALSE(fit) << fit->rate_ppm << " ppm +- " << fit->rate_std_ppm;
    EXPECT_THAT(fit.error(), HasSubstr("does not determine the clock"));
}

TEST(ClockFit, NothingInCommon_IsSaid) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 generator(seed);
        std::normal_distribution<double> draw;
        MotionTrack a, b;
        for (int k = 0; k < 3000; ++k) {
            a.time_s.push_back(0.01 * k);
            a.value.push_back(draw(generator));
            b.time_s.push_back(0.01 * k);
            b.value.push_back(draw(generator));
        }
        const auto fit = fit_clock(a, b);
        ASSERT_FALSE(fit) << fit->offset_s;
        EXPECT_THAT(fit.error(), HasSubstr("no common motion"));
    }
    const MotionTrack rest{{0.0, 1.0, 2.0}, {1.0, 1.0, 1.0}};
    EXPECT_FALSE(fit_clock(rest, rest));
    MotionTrack still;
    for (int k = 0; k < 100; ++k) {
        still.time_s.push_back(k);
        still.value.push_back(1.0);
    }
    EXPECT_THAT(fit_clock(still, track_on_clock(0.0, 0.01, 3000, 0.0, 0.0, 1.0, 0.0, 1)).error(),
                HasSubstr("does not move"));
}

}  // namespace
}  // namespace fidservo::imports
