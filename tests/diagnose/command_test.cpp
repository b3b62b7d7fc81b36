// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo diagnose, as it is called.
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::fidservo::testing::ProgramRun;
using ::fidservo::testing::run_program;
using ::fidservo::testing::TemporaryFolder;
using ::testing::HasSubstr;

TEST(DiagnoseCommand, EffectsBeforeRecordings_DoNotSwallowThem) {
    const TemporaryFolder folder;
    for (const char* option : {"--effects", "--without"}) {
        const ProgramRun run =
            run_program({"diagnose", option, "hall_gain,hall_offset", "no-such-folder"}, folder.path());
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_THAT(run.err, HasSubstr("no-such-folder")) << option;
    }
}

TEST(DiagnoseCommand, Report_IsWrittenOnce) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_program({"simulate", "rest", "--out", "rest"}, folder.path()).exit_code, 0);
    const std::vector<std::string> arguments{"diagnose", "--effects", "hall_gain",
                                             "rest",     "--report",  "report.html"};
    const ProgramRun run = run_program(arguments, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("report: report.html"));
    EXPECT_THAT(testing::text_of(folder / "report.html"), HasSubstr("No gap was found"));
    const ProgramRun again = run_program(arguments, folder.path());
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_THAT(again.err, HasSubstr("--report: report.html: exists already"));
}

TEST(DiagnoseCommand, ComparedSetsOfTwoUnits_AreNoted) {
    const TemporaryFolder folder;
    for (const char* unit : {"P-7", "P-8"}) {
        ASSERT_EQ(run_program({"simulate", "rest", "--out", unit}, folder.path()).exit_code, 0);
        std::ofstream(folder / unit / "recording.yaml", std::ios::app) << "unit: \"" << unit << "\"\n";
    }
    const ProgramRun run =
        run_program({"diagnose", "--compare", "P-7", "P-8", "--json", "compared.json"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out,
                HasSubstr("note on B: these recordings state more than one rig (unit: P-7 in A, P-8 in B)"));
    EXPECT_THAT(testing::text_of(folder / "compared.json"), HasSubstr("unit: P-7 in A, P-8 in B"));
}

TEST(DiagnoseCommand, ExperimentFile_HasAnEndingThatRecordKnows) {
    const TemporaryFolder folder;
    const ProgramRun run = run_program({"diagnose", "rest", "--write-experiment", "next.txt"}, folder.path());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("--write-experiment: next.txt: the name must end in .yaml or .yml"));
}

TEST(DiagnoseCommand, NothingTied_WritesNoExperiment_AndSaysSo) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_program({"simulate", "rest", "--out", "rest"}, folder.path()).exit_code, 0);
    const ProgramRun run = run_program(
        {"diagnose", "--effects", "hall_gain", "rest", "--write-experiment", "next.yaml"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("note: no experiment was written to next.yaml: nothing is tied"));
    EXPECT_FALSE(std::filesystem::exists(folder / "next.yaml"));
}

TEST(DiagnoseCommand, RigWithoutAWire_IsAskedForAnExperimentAsWell) {
    const TemporaryFolder folder;
    const std::string rig = testing::text_of(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    std::ofstream(folder / "carriage.yaml") << rig.substr(0, rig.find("micro:"));
    ASSERT_EQ(
        run_program({"simulate", "macro-pulses", "--rig", "carriage.yaml", "--out", "pulses"}, folder.path())
            .exit_code,
        0);
    const ProgramRun run = run_program({"diagnose", "--rig", "carriage.yaml", "--effects", "drive_offset",
                                        "pulses", "--write-experiment", "next.yaml"},
                                       folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("no experiment was written to next.yaml"));
}

/// Said before the search, which may take half a minute.
TEST(DiagnoseCommand, FormulaOfANameThatTheRigFileStates_IsRefused_UnlessItIsTheSame) {
    const TemporaryFolder folder;
    const auto formula_of = [](const char* what) {
        return fmt::format(
            "name: drag\n    block: macro.friction\n    acts_on: macro.friction\n"
            "    formula: {}\n    parameters:\n"
            "      k: {{unit: V s/mm, bounds: [0, 1e-3], typical: 1e-5",
            what);
    };
    const std::string formula = formula_of("k * speed");
    for (const auto& [file, text] :
         {std::pair{"other.yaml", formula_of("k * speed * abs(speed)")}, std::pair{"same.yaml", formula}})
        std::ofstream(folder / file) << "format: fidservo-effects/1\neffects:\n  - " << text << "}\n";
    std::string rig = testing::text_of(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    rig = rig.substr(0, rig.find("micro:"));
    std::ofstream(folder / "rig.yaml") << rig << "effects:\n  - " << formula << ", value: 1e-5}\n";
    ASSERT_EQ(
        run_program({"simulate", "rest", "--rig", "rig.yaml", "--out", "rest"}, folder.path()).exit_code, 0);
    const ProgramRun other =
        run_program({"diagnose", "--rig", "rig.yaml", "rest", "--effects-file", "other.yaml"}, folder.path());
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_THAT(other.err, HasSubstr("other.yaml: drag: the rig file states another formula of that name"));
    const ProgramRun same = run_program(
        {"diagnose", "--rig", "rig.yaml", "rest", "--effects", "drag", "--effects-file", "same.yaml"},
        folder.path());
    EXPECT_EQ(same.exit_code, 0) << same.err;
}

TEST(SlowDiagnoseCommand, Tie_LeadsToAnExperimentThatSimulateTakes) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_program({"simulate", "macro-square", "--effect", "drive_offset:offset_V=0.03", "--seed",
                           "5", "--out", "square"},
                          folder.path())
                  .exit_code,
              0);
    const ProgramRun run =
        run_program({"diagnose", "square", "--effects", "drive_offset,cable_force", "--write-experiment",
                     "my next.yaml", "--json", "found.json", "--report", "report.html"},
                    folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("experiment: my next.yaml"));
    EXPECT_THAT(testing::text_of(folder / "found.json"), HasSubstr("\"experiment\": \"my next.yaml\""));
    EXPECT_THAT(testing::text_of(folder / "report.html"), HasSubstr("The designed experiment"));
    EXPECT_THAT(testing::text_of(folder / "my next.yaml"), HasSubstr("name: my-next"));
    const ProgramRun simulated =
        run_program({"simulate", "my next.yaml", "--out", "simulated"}, folder.path());
    EXPECT_EQ(simulated.exit_code, 0) << simulated.err;
}

}  // namespace
}  // namespace fidservo
