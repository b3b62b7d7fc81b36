// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/identify/identify.h"
#include "src/simulation/simulate_reference.h"
#include "tests/src/message_of.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;
using testing::text_of;

const std::filesystem::path assets = FIDSERVO_ASSETS_DIR;

TEST(IdentifyMacro, CommandWithTheWrongSign_IsRefusedWithTheReason) {
    const Rig rig = load_rig(assets / "rig.yaml");
    Recording recording = simulate_reference(
        rig, {}, make_experiment("macro-pulses", rig, 3, "macro-pulses-1"), "macro-pulses-1", 3);
    for (StageRow& row : recording.rows) row.macro_command_V = -row.macro_command_V;
    const Identified identified = identify_macro({rig, {recording}, std::nullopt, 0.0});
    EXPECT_TRUE(identified.values.empty());
    ASSERT_EQ(identified.undetermined.size(), 1u);
    EXPECT_THAT(identified.undetermined[0].reason, HasSubstr("wrong sign"));
}

TEST(IdentifyHeater, GapInTheRecording_IsRefused) {
    const Rig rig = load_rig(assets / "rig.yaml");
    Recording recording = simulate_reference(
        rig, {}, make_experiment("micro-triangle", rig, 3, "micro-triangle-1"), "micro-triangle-1", 3);
    recording.rows.erase(recording.rows.begin() + 9000, recording.rows.begin() + 12000);
    for (const auto identify : {identify_heater, identify_hysteresis})
        EXPECT_THAT(testing::message_of([&] {
                        identify({rig, {recording}, std::nullopt, 0.0});
                    }),
                    HasSubstr("3.001 s are missing at 8.999 s"));
}

TEST(IdentifyHeater, ReadingThatNoConverterGives_IsRefused) {
    const Rig rig = load_rig(assets / "rig.yaml");
    Recording recording = simulate_reference(
        rig, {}, make_experiment("micro-triangle", rig, 3, "micro-triangle-1"), "micro-triangle-1", 3);
    recording.rows[5000].hall_adc = 9999.0;
    for (const auto identify : {identify_heater, identify_hysteresis})
        EXPECT_THAT(testing::message_of([&] {
                        identify({rig, {recording}, std::nullopt, 0.0});
                    }),
                    HasSubstr("hall [adc]: 9999 at 5 s: must be 0 to 4095"));
}

/// What the rig file states already would be in the identified numbers, and act twice.
TEST(IdentifyCommand, RigThatStatesAnEffectOfThePart_IsNotWritten) {
    const TemporaryFolder folder;
    std::filesystem::copy_file(assets / "preisach_fod.csv", folder / "preisach_fod.csv");
    folder.write("rig.yaml", text_of(assets / "rig.yaml") + "\neffects: [{name: payload, mass_factor: 2}]\n");
    ASSERT_EQ(testing::run_program({"simulate", "rest", "--out", "rest"}, folder.path()).exit_code, 0);
    const auto run = testing::run_program(
        {"identify", "macro", "rest", "--rig", "rig.yaml", "--write-rig", "new.yaml"}, folder.path());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("states the effect payload"));
}

TEST(IdentifyCommand, OneFileForTwoOutputs_IsRefusedBeforeTheWork) {
    const TemporaryFolder folder;
    const auto run = testing::run_program(
        {"identify", "macro", "nowhere", "--json", "./x", "--write-rig", "x"}, folder.path());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("are one file"));
}

}  // namespace
}  // namespace fidservo
