// SPDX-License-Identifier: GPL-3.0-or-later
// What recordings of an independent model of the reference rig, and of a real drive, say about hypotheses
// whose truth is known.
#include "core/rig.h"
#include "gap/diagnose.h"
#include "gap/evidence.h"
#include "src/files/rig/rig_file.h"
#include "tests/campaign.h"
#include "tests/gap/effect_names.h"
#include "tests/gap/effects.h"
#include "tests/gap/root_mean_square.h"
#include "tests/reference_rig.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using testing::read_all;
using testing::rms;

class Campaign : public ::testing::Test {
  protected:
    /// Skips the test where the shared data are absent.
    void read(std::string_view name) {
        const auto folders = testing::campaign(name);
        if (folders.empty()) GTEST_SKIP() << "the shared data are absent";
        evidence.emplace(reference_rig(), read_all(folders));
    }
    double in_floors(Signal signal, const Hypothesis& hypothesis = {}) const {
        return rms(*evidence, evidence->errors(hypothesis, everything(*evidence)), signal);
    }
    std::optional<Evidence> evidence;
};

TEST_F(Campaign, NoEffect_FloorsAreTheRigs) {
    read("no-effect");
    if (!evidence) return;
    EXPECT_NEAR(evidence->floor(Signal::encoder), std::sqrt(1.0 / 12.0), 1e-6);
    EXPECT_NEAR(evidence->floor(Signal::hall), std::sqrt(0.4 * 0.4 + 1.0 / 12.0), 0.003);
    EXPECT_NEAR(evidence->floor(Signal::tag), 0.02, 0.0005);
}

TEST_F(Campaign, NoEffect_ErrorsAreAtTheFloor) {
    read("no-effect");
    if (!evidence) return;
    EXPECT_GT(in_floors(Signal::hall), 0.97);
    EXPECT_LT(in_floors(Signal::hall), 1.03);
    EXPECT_GT(in_floors(Signal::tag), 0.97);
    EXPECT_LT(in_floors(Signal::tag), 1.03);
    EXPECT_LT(in_floors(Signal::encoder), 1.03);  // less where the carriage never leaves its first count
    EXPECT_LT(in_floors(Signal::macro_command), 0.1);
    EXPECT_LT(in_floors(Signal::micro_command), 0.1);
    const Errors errors = evidence->errors({}, everything(*evidence));
    for (std::size_t run = 0; run < evidence->recordings().size(); ++run) {
        const Recording& recording = evidence->recordings()[run];
        if (recording.experiment != "macro-sweep") continue;  // hardly ever at rest
        EXPECT_GT(rms(*evidence, errors, Signal::encoder, run), 0.8) << recording.name;
        EXPECT_LT(rms(*evidence, errors, Signal::encoder, run), 1.03) << recording.name;
    }
}

TEST_F(Campaign, Airflow_TheHallSensorTellsTheTruthFromNothing) {
    read("airflow");
    if (!evidence) return;
    EXPECT_GT(in_floors(Signal::hall), 5.0);
    EXPECT_NEAR(in_floors(Signal::hall, effects({"airflow:factor=0.8"})), 1.0, 0.03);
}

TEST_F(Campaign, HallNonlinearity_HallSensorAndTagsTellTheTruthFromNothing) {
    read("hall_nonlinearity");
    if (!evidence) return;
    EXPECT_GT(in_floors(Signal::hall), 5.0);
    EXPECT_GT(in_floors(Signal::tag), 5.0);
    const Hypothesis truth = effects({"hall_nonlinearity:cubic_shift=-0.12"});
    EXPECT_NEAR(in_floors(Signal::hall, truth), 1.0, 0.03);
    EXPECT_NEAR(in_floors(Signal::tag, truth), 1.0, 0.03);
}

TEST_F(Campaign, StribeckFriction_EncoderAndTagsTellTheTruthFromNothing) {
    read("stribeck_friction");
    if (!evidence) return;
    EXPECT_GT(in_floors(Signal::encoder), 10.0);
    EXPECT_GT(in_floors(Signal::tag), 5.0);
    const Hypothesis truth =
        effects({"stribeck_friction:level_V=0.399,speed_mm_per_s=12,creep_mm_per_s=0.37"});
    EXPECT_LT(in_floors(Signal::encoder, truth), 1.03);
    EXPECT_NEAR(in_floors(Signal::tag, truth), 1.0, 0.03);
}

using SlowCampaign = Campaign;

TEST_F(SlowCampaign, StribeckFriction_IsExplainedWithItsCreep) {
    read("stribeck_friction");
    if (!evidence) return;
    const Diagnosis diagnosis = diagnose(*evidence, {});
    EXPECT_EQ(diagnosis.verdict, Verdict::explained);
    ASSERT_EQ(testing::names(diagnosis), std::vector<std::string>{"stribeck_friction"});
    const auto& parameters = diagnosis.effects.front().parameters;
    ASSERT_EQ(parameters.size(), 3U);
    EXPECT_NEAR(parameters[0].value, 0.4, 0.015);
    EXPECT_NEAR(parameters[1].value, 12.0, 0.5);
    EXPECT_NEAR(parameters[2].value, 0.4, 0.15);
}

TEST(Emps, PublishedFrictionAndOffset_ExplainMostOfTheErrorOfALinearMotor) {
    const auto folder = std::filesystem::path(FIDSERVO_DATA_DIR) / "emps";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "the shared data are absent";
    const Rig rig = load_rig(folder / "rig.yaml");
    const Evidence evidence(rig, read_all(find_recordings(folder)));
    const double mm_per_floor = evidence.floor(Signal::encoder) * rig.macro.encoder_resolution_mm;
    const auto error_mm = [&](const Hypothesis& hypothesis) {
        return mm_per_floor *
               rms(evidence, evidence.errors(hypothesis, everything(evidence)), Signal::encoder);
    };
    // 20.39 N and -3.16 N of 35.1507 N/V.
    const double before_mm = error_mm({});
    const double after_mm =
        error_mm(effects({"coulomb_friction:level_V=0.580", "drive_offset:offset_V=0.090"}));
    EXPECT_LT(after_mm, 2.5);
    EXPECT_GT(before_mm, 10.0 * after_mm);
}

}  // namespace

}  // namespace fidservo
