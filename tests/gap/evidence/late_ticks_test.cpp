// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings whose loop left ticks out: the commands of the tick before went on, and nothing was read.
#include "gap/evidence/late_ticks.h"

#include "core/random.h"
#include "gap/diagnose.h"
#include "src/files/recording/writer.h"
#include "src/simulation/experiment_law.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

using testing::effects;

/// What the reference rig with effects records while its loop leaves out a share of its ticks.
Recording late_recording(const Hypothesis& truth, std::string_view kind, double share, std::uint64_t seed) {
    const Rig& rig = reference_rig();
    const Experiment experiment = make_experiment(kind, rig, seed, kind);
    const plant::StagePlant stage = plant::make_stage_plant(rig, truth);
    plant::StageState state =
        plant::start(stage, experiment.carriage_mm, seed, plant::EncoderOrigin::end_of_travel);
    NoiseStream chance(seed, "late ticks");
    Recording recording;
    recording.name = kind;
    recording.experiment = kind;
    recording.tick_s = rig.tick_s;
    recording.encoder_zero = EncoderZero{0.0, 0.0, "by construction"};
    recording.controllers = controllers_of(experiment);
    recording.columns = columns_of(rig);
    ExperimentLoops loops;
    StageRow row;
    const long ticks = std::lround(experiment.duration_s / rig.tick_s);
    for (long k = 0; k < ticks; ++k) {
        if (k == 0 || chance.uniform() >= share) {
            const plant::StageReading reading = plant::sample(stage, state);
            row.time_ns = k * nanoseconds(rig.tick_s);
            row.encoder_count = static_cast<double>(reading.encoder_count);
            row.hall_adc = reading.hall_adc;
            command_tick(rig, experiment, 0.0, static_cast<double>(k) * rig.tick_s, loops, row);
            recording.rows.push_back(row);
        }
        plant::advance(stage, state, row.macro_command_V, row.micro_command_V);
    }
    return recording;
}

Diagnosis diagnosis_of(const Hypothesis& truth, std::string_view kind, double share) {
    std::vector<Recording> recordings;
    for (const std::uint64_t seed : {31, 32}) recordings.push_back(late_recording(truth, kind, share, seed));
    return diagnose(Evidence(reference_rig(), std::move(recordings)));
}

StageRow row_at(TimeNs time_ms, double macro_V, double encoder_count, double hall_adc) {
    StageRow row{.time_ns = time_ms * ns_per_ms};
    row.macro_setpoint_mm = 1.0;
    row.macro_command_V = macro_V;
    row.encoder_count = encoder_count;
    row.hall_adc = hall_adc;
    return row;
}

Recording of_rows(std::vector<StageRow> rows) {
    Recording recording;
    recording.tick_s = 0.001;
    recording.rows = std::move(rows);
    return recording;
}

TEST(LateTicks, TwoLeftOut_CommandGoesOn_ReadingsOnTheLineInWholeNumbers) {
    Recording recording = of_rows({row_at(0, 3.5, 10.0, 2000.0), row_at(3, -4.0, 16.0, 2001.0)});
    const LateTicks late = fill_late_ticks(recording);
    EXPECT_EQ(late.is_filled, (std::vector<bool>{false, true, true, false}));
    EXPECT_EQ(late.left_out, 2U);
    ASSERT_EQ(recording.rows.size(), 4U);
    for (const std::size_t k : {1U, 2U}) {
        const StageRow& row = recording.rows[k];
        EXPECT_EQ(row.time_ns, static_cast<TimeNs>(k) * ns_per_ms);
        EXPECT_EQ(row.macro_command_V, 3.5);
        EXPECT_EQ(row.macro_setpoint_mm, 1.0);
        EXPECT_EQ(row.encoder_count, 10.0 + 2.0 * static_cast<double>(k));
        EXPECT_EQ(row.hall_adc, k == 1 ? 2000.0 : 2001.0);
        EXPECT_TRUE(std::isnan(row.micro_command_V));
    }
}

TEST(LateTicks, LongerPause_OrNoNumberOfTicks_StaysAsItIs) {
    Recording recording = of_rows({row_at(0, 3.5, 10.0, 2000.0), row_at(4, 3.5, 18.0, 2000.0)});
    recording.rows.push_back(recording.rows.back());
    recording.rows.back().time_ns += 1'500'000;
    const LateTicks late = fill_late_ticks(recording);
    EXPECT_EQ(late.is_filled, std::vector<bool>(3, false));
    EXPECT_EQ(late.left_out, 3U) << "all the same";
    EXPECT_EQ(recording.rows.size(), 3U);
}

/// 1 in 500: what a loop leaves out beside vision on a shared machine (docs/devices.md); 1 in 20: one that is
/// hardly in real time.
class Late : public ::testing::TestWithParam<double> {};

TEST_P(Late, HiddenEffect_IsNamed) {
    const Diagnosis found = diagnosis_of(effects({"drive_gain:factor=1.1"}), "macro-pulses", GetParam());
    ASSERT_EQ(found.effects.size(), 1U);
    EXPECT_EQ(found.effects.front().effect, "drive_gain");
    EXPECT_GT(found.effects.front().probability, 0.9);
    EXPECT_NEAR(found.effects.front().parameters.front().value, 1.1, 0.001);
    EXPECT_EQ(found.verdict, Verdict::explained);
    EXPECT_LT(found.gap.after, 1.1);
}

TEST_P(Late, NothingHidden_NoGap_AndTheControllerIsTheFiles) {
    const Evidence evidence(reference_rig(), {late_recording({}, "macro-square", GetParam(), 31),
                                              late_recording({}, "macro-square", GetParam(), 32)});
    EXPECT_TRUE(std::ranges::any_of(
        evidence.windows(), [](const Window& window) { return window.signal == Signal::macro_command; }));
    const Diagnosis found = diagnose(evidence);
    EXPECT_EQ(found.verdict, Verdict::no_gap);
    EXPECT_LT(found.gap.before, 1.1);
}

TEST(LateTicks, LoopThatIsNotInRealTime_IsSaid) {
    const Evidence evidence(reference_rig(), {late_recording({}, "macro-pulses", 0.4, 31)});
    const auto said = std::ranges::find(evidence.omissions(), "rows", &Omission::signal);
    ASSERT_NE(said, evidence.omissions().end());
    EXPECT_TRUE(said->why.starts_with("the loop left out 40 % of its ticks")) << said->why;
}

INSTANTIATE_TEST_SUITE_P(Shares, Late, ::testing::Values(0.002, 0.05));

}  // namespace
}  // namespace fidservo::gap
