// SPDX-License-Identifier: GPL-3.0-or-later
// Starts of waves, where the errors are those of a wave that is known.
#include "gap/starts/wave_starts.h"

#include "gap/candidates/wave.h"
#include "plant/effects/catalogue.h"
#include "tests/gap/equal_windows.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

const plant::Effect& cogging() {
    return *plant::find_effect("cogging");
}

plant::EffectSetting wave_with(double amplitude_V, double period_mm, double phase_rad) {
    plant::EffectSetting setting = plant::vanishing_setting(cogging());
    const WaveParameters places = *wave_of(cogging());
    setting.values[places.amplitude] = amplitude_V;
    setting.values[places.period] = period_mm;
    setting.values[places.phase] = phase_rad;
    return setting;
}

class WaveStarts : public ::testing::Test {
  protected:
    static constexpr std::size_t windows = 40, rows_each = 50;
    static constexpr double rail_mm = 200.0, floors_per_V = 1000.0;

    static double at(const plant::EffectSetting& wave, std::size_t row) {
        const WaveParameters places = *wave_of(cogging());
        const double y_mm = rail_mm * static_cast<double>(row) / (windows * rows_each);
        return floors_per_V * wave.values[places.amplitude] *
               std::sin(2.0 * std::numbers::pi * y_mm / wave.values[places.period] +
                        wave.values[places.phase]);
    }

    /// The errors that a hypothesis leaves of the true wave, beside others that no wave changes.
    Errors left_by(const Hypothesis& hypothesis) const {
        Errors errors(windows * rows_each);
        for (std::size_t row = 0; row < errors.size(); ++row) {
            const double here = hypothesis.empty() ? 0.0 : at(hypothesis.back(), row);
            errors[row] = static_cast<float>(others_floors_ + at(truth_, row) - here);
        }
        return errors;
    }

    std::vector<Promise> starts(const std::vector<plant::EffectSetting>& balanced) const {
        const std::vector<Window> all = testing::equal_windows(windows, rows_each);
        const Wanted counted(windows, 1);
        const Predict predict = [&](const Hypothesis& hypothesis) { return left_by(hypothesis); };
        const Candidate candidate{.effect = &cogging(),
                                  .sizes = {wave_of(cogging())->amplitude},
                                  .shapes = {plant::typical_setting(cogging()).values},
                                  .wave = wave_of(cogging()),
                                  .patch = {},
                                  .class_name = "cogging"};
        return waves_at_first_sight(predict, all, counted,
                                    surroundings(predict, all, counted, {}, predict({}), {}), candidate, {},
                                    balanced);
    }

    const plant::EffectSetting truth_ = wave_with(0.05, 5.0, 0.4);
    double others_floors_ = 0.0;
};

/// From a period that is an eighth of a turn off at the rail's ends: near enough for a fit.
TEST_F(WaveStarts, NearTheTrueWave_ClimbToIt) {
    const double from_mm = 1.0 / (1.0 / 5.0 + 0.25 / rail_mm);
    const std::vector<Promise> found = starts({wave_with(0.04, from_mm, phase_in_step(0.4, 5.0, from_mm))});
    ASSERT_EQ(found.size(), 1U);
    const std::vector<double>& values = found.front().start.back().values;
    const WaveParameters places = *wave_of(cogging());
    EXPECT_NEAR(values[places.amplitude], 0.05, 0.01);
    EXPECT_NEAR(values[places.period], 5.0, 0.003);
    EXPECT_NEAR(std::remainder(phase_in_step(values[places.phase], values[places.period], 5.0) - 0.4,
                               2.0 * std::numbers::pi),
                0.0, 0.1);
}

TEST_F(WaveStarts, AtMostFour_AndThoseThatPromiseMostFirst) {
    std::vector<plant::EffectSetting> waves;
    for (const double period_mm : {3.1, 4.2, 5.0, 7.7, 9.3, 12.1})
        waves.push_back(wave_with(0.05, period_mm, 0.4));
    const std::vector<Promise> found = starts(waves);
    ASSERT_EQ(found.size(), 4U);
    EXPECT_EQ(found.front().start.back().values, truth_.values);
    for (std::size_t k = 1; k < found.size(); ++k) EXPECT_GE(found[k - 1].gain, found[k].gain);
}

TEST_F(WaveStarts, OfWhatIsSmallBesideOtherErrors_AreNotFollowed) {
    others_floors_ = 1000.0;
    const plant::EffectSetting near = wave_with(0.04, 5.0, 0.4);
    const std::vector<Promise> found = starts({near});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found.front().start.back().values, near.values);
}

TEST_F(WaveStarts, OfOtherEffects_AreLeftOut) {
    EXPECT_TRUE(starts({plant::typical_setting(*plant::find_effect("encoder_ripple"))}).empty());
}

}  // namespace
}  // namespace fidservo
