// SPDX-License-Identifier: GPL-3.0-or-later
// The effects' equations against an independent model's: one value, estimated on one recording of a rig with
// the effect, must explain the readings of all others.
#include "plant/effects/catalogue.h"
#include "src/files/recording/reader.h"
#include "tests/campaign.h"
#include "tests/plant/campaign_residual.h"
#include "tests/plant/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

/// The value of an effect's only parameter that minimises the Hall residual: a golden-section search, as the
/// residual increases to both sides.
double estimated_value(const Effect& effect, const Recording& recording) {
    double low = effect.parameters[0].low, high = effect.parameters[0].high;
    const double shrink = 1.0 / std::numbers::phi;
    const auto rms_lsb = [&](double value) {
        EffectSetting setting = typical_setting(effect);
        setting.values.front() = value;
        return hall_residual(make_stage_plant(reference_rig(), {&setting, 1}), recording).rms_lsb;
    };
    constexpr double resolution = 1e-6;
    while (high - low > resolution) {
        const double left = high - shrink * (high - low);
        const double right = low + shrink * (high - low);
        if (rms_lsb(left) < rms_lsb(right))
            high = right;
        else
            low = left;
    }
    return 0.5 * (low + high);
}

class PracticeCampaign : public ::testing::TestWithParam<std::string_view> {};

TEST_P(PracticeCampaign, ValueOfOneRecording_ExplainsTheOthersToTheNoiseFloor) {
    const Effect& effect = *find_effect(GetParam());
    const auto recordings = testing::campaign(effect.name);
    if (recordings.empty()) GTEST_SKIP() << "the shared data are absent";
    const auto estimated_on = std::ranges::find(recordings, "micro-triangle-1",
                                                [](const auto& path) { return path.filename().string(); });
    ASSERT_NE(estimated_on, recordings.end());
    EffectSetting setting = typical_setting(effect);
    setting.values.front() = estimated_value(effect, read_recording(*estimated_on));
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = make_stage_plant(reference_rig(), {&setting, 1});

    std::printf("%s %.4f, by micro-triangle-1\n", effect.parameters[0].name.data(), setting.values[0]);
    std::printf("recording           Hall r.m.s., LSB: nominal   with it  expected   sigma\n");
    double worst_nominal_lsb = 0.0;
    for (const auto& path : recordings) {
        const Recording recording = read_recording(path);
        SCOPED_TRACE(recording.name);
        const HallResidual before = hall_residual(nominal, recording),
                           after = hall_residual(plant, recording);
        std::printf("%-18s                  %9.4f  %8.4f  %8.4f  %+6.2f\n", recording.name.c_str(),
                    before.rms_lsb, after.rms_lsb, after.expected_rms_lsb, after.sigma());
        worst_nominal_lsb = std::max(worst_nominal_lsb, before.rms_lsb);
        EXPECT_LE(std::abs(after.sigma()), 4.0);
    }
    EXPECT_GT(worst_nominal_lsb, 3.0) << "there must be something to explain";
}

INSTANTIATE_TEST_SUITE_P(MicroStage, PracticeCampaign, ::testing::Values("airflow", "hall_nonlinearity"),
                         [](const auto& instance) { return std::string(instance.param); });

/// R.m.s. of position minus recorded count, in counts, about its mean, as the position within the first count
/// is unknown.
double encoder_rms_count(const StagePlant& plant, const Recording& recording) {
    const double count_mm = plant.encoder.resolution_mm;
    StageState state =
        start(plant, count_mm * recording.rows.front().encoder_count, 1, EncoderOrigin::end_of_travel);
    double sum = 0.0, squares = 0.0;
    for (const StageRow& row : recording.rows) {
        const double error = state.axis.position_mm / count_mm - row.encoder_count;
        sum += error;
        squares += error * error;
        advance(plant.axis, state.axis, row.macro_command_V);
    }
    const double ticks = static_cast<double>(recording.rows.size());
    return std::sqrt(std::max(0.0, squares / ticks - sum / ticks * sum / ticks));
}

/// The values were fitted to macro-sweep-1 and macro-pulses-1, by another program.
TEST(PracticeCampaignOnTheRail, StribeckValuesOfTwoRecordings_ExplainTheOthers) {
    const auto recordings = testing::campaign("stribeck_friction");
    if (recordings.empty()) GTEST_SKIP() << "the shared data are absent";
    const EffectSetting setting =
        parse_effect("stribeck_friction:level_V=0.399,speed_mm_per_s=12,creep_mm_per_s=0.37");
    const StagePlant nominal = make_stage_plant(reference_rig());
    const StagePlant plant = make_stage_plant(reference_rig(), {&setting, 1});
    std::printf("recording           encoder r.m.s., counts: nominal   with it   (rounding 0.289)\n");
    double worst_nominal = 0.0;
    for (const auto& path : recordings) {
        const Recording recording = read_recording(path);
        SCOPED_TRACE(recording.name);
        const double before = encoder_rms_count(nominal, recording),
                     after = encoder_rms_count(plant, recording);
        std::printf("%-18s                          %9.3f  %8.3f\n", recording.name.c_str(), before, after);
        worst_nominal = std::max(worst_nominal, before);
        EXPECT_LE(after, 1.0);
    }
    EXPECT_GT(worst_nominal, 20.0) << "there must be something to explain";
}

}  // namespace
}  // namespace fidservo::plant
