// SPDX-License-Identifier: GPL-3.0-or-later
// Linear models of what is left: found where there is something, and only there.
#include "gap/fit/regression.h"

#include "core/random.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

constexpr std::size_t values = 200, count = 24;
constexpr int wave = 3, ramp = 5;  // groups

struct Setting {
    std::vector<Window> windows;
    std::vector<std::uint8_t> half;
    std::vector<Column> columns, nuisances;
    Errors noise;
};

/// Windows of noise of one floor; a wave and a ramp that begins anew in each as columns.
Setting make_setting(std::uint64_t seed) {
    Setting setting;
    NoiseStream random(seed, "noise");
    Column sine{wave, {}}, rise{ramp, {}}, constant{0, {}};
    for (std::size_t w = 0; w < count; ++w) {
        Window window;
        window.run = w / 4;
        window.begin = w * values;
        window.end = window.begin + values;
        setting.windows.push_back(window);
        setting.half.push_back(static_cast<std::uint8_t>(w / 4 % 2));
        for (std::size_t k = 0; k < values; ++k) {
            const double share = static_cast<double>(k) / values;
            sine.values.push_back(static_cast<float>(std::sin(2.0 * std::numbers::pi * 3.0 * share)));
            rise.values.push_back(static_cast<float>(share));
            constant.values.push_back(1.0F);
            setting.noise.push_back(static_cast<float>(random.normal()));
        }
    }
    setting.columns = {sine, rise};
    setting.nuisances = {constant};
    return setting;
}

Errors sum(const Errors& noise, const Column& column, float factor) {
    Errors errors = noise;
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] += factor * column.values[k];
    return errors;
}

Regression regression(const Setting& setting, const Errors& errors) {
    return {setting.windows, Signal::encoder, errors, setting.columns, setting.nuisances, setting.half};
}

TEST(Regression, GroupThatIsThere_IsFoundAlone_AndLeavesTheNoise) {
    constexpr std::uint64_t seed = 3;
    SCOPED_TRACE(seed);
    const Setting setting = make_setting(seed);
    const Regression found = regression(setting, sum(setting.noise, setting.columns[0], 4.0F));
    EXPECT_EQ(found.significant_groups(0.01, 0.8), std::vector{wave});
    const int groups[] = {wave};
    for (const double square : found.mean_squares(groups)) EXPECT_NEAR(square, 1.0, 0.6);
    for (const double square : found.mean_squares({})) EXPECT_NEAR(square, 9.0, 2.5);  // 1 + 4^2 / 2
}

TEST(Regression, BothGroups_AreFoundInTheOrderOfWhatTheyAdd) {
    const Setting setting = make_setting(4);
    const Errors errors = sum(sum(setting.noise, setting.columns[1], 30.0F), setting.columns[0], 3.0F);
    EXPECT_EQ(regression(setting, errors).significant_groups(0.01, 0.8), (std::vector{ramp, wave}));
}

/// A plainer group that comes near is preferred only where the data cannot tell that it is not the one.
TEST(Regression, PlainGroupThatComesNear_YieldsToARichOneThatLeadsForCertain) {
    constexpr int near = 1;
    Setting setting = make_setting(7);
    Column nearly{near, sum(setting.columns[0].values, setting.columns[1], 0.2F)};
    setting.columns[1].group = wave;
    setting.columns.push_back(nearly);
    const auto first = [&](float factor) {
        return regression(setting, sum(setting.noise, setting.columns[0], factor))
            .significant_groups(0.01, 0.8)
            .front();
    };
    EXPECT_EQ(first(1.0F), near);
    EXPECT_EQ(first(30.0F), wave);
}

TEST(Regression, WhatTheStateAtAWindowsStartExplains_IsNoFinding) {
    Setting setting = make_setting(5);
    Errors errors = setting.noise;
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] += static_cast<float>(k / values % 7) * 50.0F;
    EXPECT_TRUE(regression(setting, errors).significant_groups(0.01, 0.8).empty());
}

/// As a place that one half of the recordings hardly visits.
TEST(Regression, ColumnThatAHalfHardlyHas_IsHeldByItsGroup) {
    constexpr float share_in_first_half = 0.003F;
    Setting setting = make_setting(6);
    Column rare{ramp, setting.columns[0].values};
    for (std::size_t k = 0; k < rare.values.size(); ++k)
        if (setting.half[k / values] == 0) rare.values[k] *= share_in_first_half;
    setting.columns[0] = rare;
    const int groups[] = {ramp};
    const Errors errors = sum(setting.noise, setting.columns[1], 30.0F);
    for (const double square : regression(setting, errors).mean_squares(groups)) EXPECT_LT(square, 2.0);
}

TEST(Regression, Noise_IsNoFinding) {
    constexpr int draws = 200;
    int findings = 0;
    for (int seed = 1; seed <= draws; ++seed) {
        const Setting setting = make_setting(static_cast<std::uint64_t>(seed));
        findings += regression(setting, setting.noise).significant_groups(0.01, 0.8).empty() ? 0 : 1;
    }
    EXPECT_LE(findings, 6);  // 1 % expected; 7 or more of 200 have a chance of 0.5 %
}

}  // namespace

}  // namespace fidservo
