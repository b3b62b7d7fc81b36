// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/recording/row_format.h"
#include "src/simulation/simulate.h"
#include "tests/reference_rig.h"

#include <gtest/gtest.h>

namespace fidservo {
namespace {

Recording run(const Rig& rig, std::string_view kind, std::uint64_t seed, const std::string& effect = "") {
    std::vector<plant::EffectSetting> effects;
    if (!effect.empty()) effects.push_back(plant::parse_effect(effect));
    const std::string name = std::string(kind) + "-1";
    return simulate(rig, effects, make_experiment(kind, rig, seed, name), name, seed);
}

std::string text_of(const Recording& recording) {
    std::string text;
    for (const StageRow& row : recording.rows) append_row(text, row, recording.columns);
    for (const TagDetection& detection : recording.detections) append_detection(text, detection);
    return text;
}

TEST(Simulate, EveryExperiment_LastsAsLongAsInTheSharedCampaigns) {
    const Rig& rig = reference_rig();
    const std::pair<std::string_view, std::size_t> ticks[] = {
        {"rest", 4000},         {"macro-pulses", 12600},   {"macro-sweep", 12000}, {"macro-square", 16000},
        {"micro-steps", 35000}, {"micro-triangle", 32000}, {"micro-servo", 30000}, {"integrated", 40000}};
    ASSERT_EQ(std::size(ticks), experiment_kinds().size());
    for (const auto& [kind, expected] : ticks) EXPECT_EQ(run(rig, kind, 5).rows.size(), expected) << kind;
}

TEST(Simulate, SameSeed_GivesTheSameBytesAndAnotherSeedDoesNot) {
    const Rig& rig = reference_rig();
    EXPECT_TRUE(text_of(run(rig, "macro-square", 5)) == text_of(run(rig, "macro-square", 5)));
    EXPECT_FALSE(text_of(run(rig, "macro-square", 5)) == text_of(run(rig, "macro-square", 6)));
}

TEST(Simulate, MacroSquare_ReachesItsSetpointsWithinTwoCounts) {
    const Rig& rig = reference_rig();
    const Recording recording = run(rig, "macro-square", 5);
    for (std::size_t k = 1999; k < recording.rows.size(); k += 2000) {
        const StageRow& row = recording.rows[k];
        EXPECT_NEAR(row.encoder_count, row.macro_setpoint_mm / rig.macro.encoder_resolution_mm, 2.0) << k;
        EXPECT_EQ(row.micro_command_V, 0.0);
        EXPECT_TRUE(std::isnan(row.micro_setpoint_mm));
    }
}

TEST(Simulate, FramesAtRest_ShowTheNearestTagWithTheRigsCornerNoise) {
    const Rig& rig = reference_rig();
    const Recording recording = run(rig, "rest", 5);
    ASSERT_EQ(recording.detections.size(), 200u);
    EXPECT_EQ(recording.detections.front().time_ns, 3'300'000);
    EXPECT_EQ(recording.detections[1].time_ns, 23'300'000);
    double sum_px2 = 0.0;
    for (const TagDetection& detection : recording.detections) {
        EXPECT_EQ(detection.tag_id, recording.detections.front().tag_id);
        sum_px2 += std::pow(detection.corners_px[0].y() - 629.5, 2);
    }
    // 200 draws: the r.m.s. scatters by 5 % of itself
    EXPECT_NEAR(std::sqrt(sum_px2 / 200.0), rig.camera->corner_noise_px,
                4 * 0.05 * rig.camera->corner_noise_px);
}

TEST(Simulate, LateCameraClock_ShiftsTheStamps) {
    const Recording recording = run(reference_rig(), "rest", 5, "camera_latency:delay_ms=7");
    EXPECT_EQ(recording.detections.front().time_ns, 10'300'000);
}

TEST(Simulate, RigWithoutMicroStage_RefusesWhatNeedsIt) {
    Rig rig = reference_rig();
    rig.micro.reset();
    EXPECT_EQ(missing_for("integrated", rig), "micro");
    EXPECT_EQ(missing_for("macro-pulses", rig), "");
    EXPECT_THROW(make_experiment("micro-servo", rig, 1, "a"), InputError);
    const Recording recording = run(rig, "macro-pulses", 5);
    EXPECT_FALSE(recording.columns.hall);
}

}  // namespace
}  // namespace fidservo
