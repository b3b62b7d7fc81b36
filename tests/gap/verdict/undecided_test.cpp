// SPDX-License-Identifier: GPL-3.0-or-later
// What a diagnosis reports as undecidable.
#include "core/input_error.h"
#include "core/random.h"
#include "gap/diagnose.h"
#include "src/simulation/experiments.h"
#include "src/simulation/simulate.h"
#include "tests/gap/effects.h"
#include "tests/reference_rig.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using ::testing::AllOf;
using ::testing::Contains;
using testing::effects;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

Recording simulated(const Hypothesis& truth, std::string_view kind, std::uint64_t seed) {
    const std::string name(kind);
    return simulate(reference_rig(), truth, make_experiment(kind, reference_rig(), seed, name), name, seed);
}

TEST(Undecided, RigAtRest_ShowsNeitherFrictionNorHeater) {
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), {simulated({}, "rest", 3)}));
    EXPECT_EQ(diagnosis.verdict, Verdict::no_gap);
    EXPECT_THAT(diagnosis.notes,
                Contains(AllOf(StartsWith("macro.friction: "), HasSubstr("viscous_friction"))));
    EXPECT_THAT(diagnosis.notes, Contains(AllOf(StartsWith("micro.heater: "), HasSubstr("airflow"))));
    EXPECT_THAT(diagnosis.notes, Not(Contains(HasSubstr("hall_offset"))));
}

TEST(Undecided, MovingCarriage_ShowsItsFrictionButNotTheWire) {
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), {simulated({}, "macro-pulses", 3)}));
    EXPECT_THAT(diagnosis.notes, Not(Contains(HasSubstr("viscous_friction"))));
    EXPECT_THAT(diagnosis.notes, Contains(HasSubstr("airflow")));
}

TEST(Undecided, RecordingShorterThanAWindow_IsRefused) {
    Recording recording = simulated(effects({"drive_gain:factor=0.8"}), "macro-pulses", 3);
    recording.rows.resize(80);
    recording.detections.clear();
    EXPECT_THROW(diagnose(Evidence(reference_rig(), {recording})), InputError);
}

TEST(SlowUndecided, ShortRecording_NamesAGuessAsSuch) {
    Recording recording = simulated(effects({"drive_gain:factor=0.8"}), "macro-pulses", 3);
    recording.rows.resize(2000);
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), {recording}));
    EXPECT_THAT(diagnosis.effects, IsEmpty());
    ASSERT_TRUE(diagnosis.unexplained);
    EXPECT_THAT(diagnosis.unexplained->text, HasSubstr("too few"));
    ASSERT_FALSE(diagnosis.where.empty());
    EXPECT_LE(diagnosis.where.front().probability, 0.5);
}

TEST(SlowUndecided, RecordingOfAnotherRig_IsAskedAbout) {
    Recording recording = simulated({}, "macro-pulses", 3);
    recording.rig = "another";
    for (StageRow& row : recording.rows) row.macro_command_V = -row.macro_command_V;
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), {recording}));
    EXPECT_THAT(diagnosis.notes, Contains(HasSubstr("of the rig \"another\"")));
    EXPECT_THAT(diagnosis.notes, Contains(HasSubstr("stays where it is")));
}

TEST(Undecided, PartsThatAreLeftOut_AreOneLineForAllRecordings) {
    std::vector<Recording> recordings;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        recordings.push_back(simulated({}, "macro-sweep", seed));
        std::vector<StageRow>& rows = recordings.back().rows;
        rows.erase(rows.begin() + 5000, rows.begin() + 6000);
    }
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), recordings));
    EXPECT_EQ(diagnosis.verdict, Verdict::no_gap);
    EXPECT_EQ(std::ranges::count_if(
                  diagnosis.notes,
                  [](const std::string& note) { return note.find("are not judged") != std::string::npos; }),
              1);
    EXPECT_THAT(diagnosis.notes, Contains(HasSubstr(" recordings: encoder: ")));
}

/// Rows missing at random places for up to 0.3 s, and half of the frames.
TEST(SlowUndecided, GapsAndDroppedFrames_DoNotAccuseTheControllers) {
    constexpr std::uint64_t seed = 5;
    NoiseStream draw(seed, "gaps");
    std::vector<Recording> recordings;
    for (const std::string_view kind : {"integrated", "micro-servo", "micro-triangle", "macro-square"})
        for (std::uint64_t run = 1; run <= 2; ++run) {
            Recording recording = simulated(effects({"airflow:factor=0.8"}), kind, run);
            for (int gap = 0; gap < 3; ++gap) {
                const auto first = static_cast<std::ptrdiff_t>(
                    draw.uniform() * static_cast<double>(recording.rows.size() - 400));
                const auto rows = static_cast<std::ptrdiff_t>(1.0 + 300.0 * draw.uniform());
                recording.rows.erase(recording.rows.begin() + first, recording.rows.begin() + first + rows);
            }
            std::erase_if(recording.detections, [&](const TagDetection&) { return draw.uniform() < 0.5; });
            recordings.push_back(std::move(recording));
        }
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), recordings));
    ASSERT_EQ(diagnosis.effects.size(), 1U) << "seed " << seed;
    EXPECT_EQ(diagnosis.effects[0].effect, "airflow");
    EXPECT_GT(diagnosis.effects[0].probability, 0.9);
    for (const SignalGap& signal : diagnosis.signals)
        if (signal.signal == Signal::macro_command || signal.signal == Signal::micro_command) {
            EXPECT_LT(signal.after, signal.floor) << name_of(signal.signal);
        }
}

}  // namespace

}  // namespace fidservo
