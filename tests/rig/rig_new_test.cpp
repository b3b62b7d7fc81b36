// SPDX-License-Identifier: GPL-3.0-or-later
// The rig file to start from: it loads, and commands take it.
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/rig/draft.h"
#include "src/rig/finding.h"
#include "src/rig/generic_fod.h"
#include "src/rig/questions.h"
#include "tests/src/message_of.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo {
namespace {

using testing::message_of;
using testing::ProgramRun;
using testing::run_program;
using testing::TemporaryFolder;
using testing::text_of;

ProgramRun run_new(const TemporaryFolder& folder, std::vector<std::string> options) {
    options.insert(options.begin(), {"rig", "new", "--out", "rig.yaml"});
    return run_program(options, folder.path());
}

TEST(RigNew, EveryKind_LoadsAndNothingLooksWrong) {
    for (const char* kind : {"axis", "camera", "full"}) {
        const TemporaryFolder folder;
        const ProgramRun run = run_new(folder, {"--kind", kind});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.out, "rig file: rig.yaml\n");
        const Rig rig = load_rig(folder / "rig.yaml");
        EXPECT_EQ(rig.micro.has_value(), std::string(kind) == "full");
        EXPECT_EQ(rig.camera && rig.fiducials, std::string(kind) != "axis");
        const ProgramRun check =
            run_program({"rig", "check", "rig.yaml", "--json", "check.json"}, folder.path());
        EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
        EXPECT_NE(check.out.find("nothing looks wrong"), std::string::npos);
        const auto json = nlohmann::json::parse(text_of(folder / "check.json"));
        EXPECT_EQ(json.at("format"), "fidservo-rig-check/1");
        EXPECT_TRUE(json.at("findings").empty());
        EXPECT_FALSE(json.at("abilities").empty());
    }
}

TEST(RigNew, NumbersGiven_StandInTheFile) {
    const TemporaryFolder folder;
    const ProgramRun run = run_new(
        folder,
        {"--name",           "bench-2",   "--travel-mm",       "-50,250", "--resolution-mm",   "0.01",
         "--tick-s",         "0.002",     "--command-limit-V", "10",      "--micro-travel-mm", "0.5,3.5",
         "--heater-onset-V", "1",         "--heater-limit-V",  "3",       "--adc-bits",        "14",
         "--image-px",       "1600,1200", "--focal-px",        "4000",    "--distance-mm",     "25",
         "--tag-side-mm",    "1.5",       "--pitch-mm",        "2.5",     "--first-id",        "7",
         "--rows",           "2"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Rig rig = load_rig(folder / "rig.yaml");
    EXPECT_EQ(rig.name, "bench-2");
    EXPECT_EQ(rig.tick_s, 0.002);
    EXPECT_EQ(rig.macro.low_mm, -50.0);
    EXPECT_EQ(rig.macro.high_mm, 250.0);
    EXPECT_EQ(rig.macro.encoder_resolution_mm, 0.01);
    EXPECT_EQ(rig.macro.command_limit_V, 10.0);
    EXPECT_NEAR(rig.macro.velocity_gain_mm_per_s_per_V * 0.8 * 10.0, 600.0, 1.0);
    EXPECT_NEAR(rig.macro.velocity_pole, std::exp(-0.002 / 0.05), 1e-6);
    EXPECT_EQ(rig.micro->low_mm, 0.5);
    EXPECT_NEAR(rig.micro->fod->stroke_mm(), 3.0, 0.01);
    EXPECT_EQ(rig.micro->heater.limit_V, 3.0);
    EXPECT_EQ(rig.micro->hall.adc_bits, 14);
    EXPECT_EQ(rig.camera->geometry.width_px, 1600);
    EXPECT_EQ(rig.camera->geometry.distance_mm, 25.0);
    EXPECT_EQ(rig.fiducials->columns, 101);  // 250 mm / 2.5 mm, and one at 0
    EXPECT_EQ(rig.fiducials->rows, 2);
    EXPECT_EQ(rig.fiducials->first_id, 7);
}

TEST(RigNew, TableGiven_IsNamedFromTheRigFilesFolder) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "rigs");
    std::filesystem::copy_file(FIDSERVO_ASSETS_DIR "/preisach_fod.csv", folder / "wire's.csv");
    const ProgramRun run =
        run_program({"rig", "new", "--out", "rigs/a.yaml", "--fod", "wire's.csv"}, folder.path());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "rigs/a_fod.csv"));
    EXPECT_NEAR(load_rig(folder / "rigs/a.yaml").micro->fod->stroke_mm(), 4.0, 1e-3);
}

/// 1 is an answer too: what the recordings leave open is not identified.
void expect_taken(const TemporaryFolder& folder, const std::vector<std::string>& command, int worst = 0) {
    const ProgramRun run = run_program(command, folder.path());
    EXPECT_GE(run.exit_code, 0);
    EXPECT_LE(run.exit_code, worst) << command[0] << " " << command[1] << "\n" << run.out << run.err;
}

TEST(SlowRigNew, Motions_AreDoneByWhatItDescribes) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_new(folder, {}).exit_code, 0);
    expect_taken(folder, {"home", "--rig", "rig.yaml"});
    expect_taken(folder, {"record", "--duration", "0.1", "--frames", "--rig", "rig.yaml", "--out", "rest"});
    expect_taken(folder, {"replay", "rest", "--rig", "rig.yaml", "--out", "replayed"});
}

TEST(SlowRigNew, EveryOtherCommand_TakesIt) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_new(folder, {}).exit_code, 0);
    expect_taken(folder, {"goto", "--tag", "30", "--dx-um", "150", "--hold", "0.1", "--rig", "rig.yaml"});
    expect_taken(folder, {"calibrate", "stage", "--check", "--rig", "rig.yaml"});
    const std::string recipe = FIDSERVO_SOURCE_DIR "/tests/faults/drill.yaml";
    expect_taken(folder, {"inspect", recipe, "--rig", "rig.yaml", "--out", "run", "--no-diagnosis"}, 1);
    expect_taken(folder, {"simulate", "campaign", "--rig", "rig.yaml", "--out", "campaign"});
    expect_taken(folder, {"identify", "macro", "campaign/macro-square-1", "--rig", "rig.yaml"}, 1);
    for (const char* part : {"hysteresis", "heater"})
        expect_taken(folder, {"identify", part, "campaign", "--rig", "rig.yaml"}, 1);
    expect_taken(folder, {"calibrate", "hall", "campaign", "--rig", "rig.yaml"}, 1);
    expect_taken(folder, {"diagnose", "campaign", "--rig", "rig.yaml"});
}

TEST(SlowRigNew, AxisAlone_IsSimulatedAndIdentified) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_new(folder, {"--kind", "axis", "--travel-mm=-150,150"}).exit_code, 0);
    expect_taken(folder, {"simulate", "campaign", "--rig", "rig.yaml", "--out", "c"});
    expect_taken(folder, {"identify", "macro", "c", "--rig", "rig.yaml", "--write-rig", "identified.yaml"});
    const DeadZone zone = load_rig(folder / "identified.yaml").macro.dead_zone;
    EXPECT_NEAR(zone.threshold_V, 1.0, 0.01);  // the guess, which the simulated rig has
    EXPECT_NEAR(zone.offset_V, 0.0, 0.01);
    expect_taken(folder, {"rig", "check", "identified.yaml"});
}

TEST(RigNew, WhatCannotBe_IsRefused) {
    const TemporaryFolder folder;
    folder.write("there.yaml", "mine\n");
    folder.write("x_fod.csv", "mine\n");
    const std::pair<std::vector<std::string>, std::string> wrong[] = {
        {{"--out", "there.yaml"}, "there.yaml: exists already"},
        {{"--out", "x.yaml"}, "x_fod.csv: exists already"},
        {{"--out", "y.yaml", "--travel-mm", "200,0"}, "--travel-mm: 200,0"},
        {{"--out", "y.yaml", "--resolution-mm", "0"}, "--resolution-mm"},
        {{"--out", "y.yaml", "--friction-V", "5"}, "--friction-V: 5: must be below --command-limit-V, 5 V"},
        {{"--out", "y.yaml", "--pitch-mm", "1"}, "--pitch-mm: 1: must be above --tag-side-mm, 1.2 mm"},
        {{"--out", "y.yaml", "--columns", "300", "--rows", "2"}, "tag36h11 has 587"},
        {{"--out", "y.yaml", "--heater-limit-V", "1"}, "--heater-limit-V: 1: must be above"},
        {{"--out", "y.yaml", "--kind", "robot"}, "--kind"},
        {{"--out", "y.yaml", "--name", "a: b"}, "--name: a: b"},
        {{"--out", "y.yaml", "--fod", "nowhere.csv"}, "nowhere.csv"}};
    for (auto [arguments, piece] : wrong) {
        arguments.insert(arguments.begin(), {"rig", "new"});
        const ProgramRun run = run_program(arguments, folder.path());
        EXPECT_EQ(run.exit_code, 2) << piece;
        EXPECT_NE(run.err.find(piece), std::string::npos) << piece << "\n" << run.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.yaml"));
        EXPECT_FALSE(std::filesystem::exists(folder / "y.yaml"));
    }
    EXPECT_EQ(text_of(folder / "there.yaml"), "mine\n");
}

TEST(RigNew, Questions_AreAskedForWhatIsNotGiven) {
    RigDraft draft;
    std::istringstream answers("camera\nbench\n-10, 300\nten\n0.02\n\n2.9\n");  // then the input ends
    std::ostringstream questions;
    ask(
        draft, [](std::string_view option) { return option == "--tag-side-mm"; }, answers, questions);
    EXPECT_EQ(draft.kind, RigKind::camera);
    EXPECT_EQ(draft.name, "bench");
    EXPECT_EQ(draft.travel_mm, (std::array{-10.0, 300.0}));
    EXPECT_EQ(draft.resolution_mm, 0.02);
    EXPECT_EQ(draft.command_limit_V, 5.0);
    EXPECT_EQ(draft.friction_V, 2.9);
    EXPECT_EQ(draft.pitch_mm, 2.0);
    const std::string text = questions.str();
    EXPECT_EQ(text.find("tag's"), std::string::npos);
    EXPECT_EQ(text.find("wire"), std::string::npos);
    const std::string encoder = "A count of its encoder, in mm? [0.05] ";
    const auto first = text.find(encoder);
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_NE(text.find(encoder, first + 1), std::string::npos);  // "ten" is no answer
}

TEST(GenericFod, Curves_AreThoseOfAWire) {
    const FodTable fod = generic_fod(4.0);
    EXPECT_NEAR(fod.stroke_mm(), 4.0, 0.01);
    EXPECT_NEAR(fod.contraction_mm(20.0, 20.0), 0.0, 1e-4);
    for (std::size_t peak = 1; peak < fod.nodes(); ++peak) {
        EXPECT_GE(fod.node_mm(peak, peak), fod.node_mm(peak - 1, peak - 1));
        for (std::size_t temp = 1; temp <= peak; ++temp)
            EXPECT_GE(fod.node_mm(peak, temp), fod.node_mm(peak, temp - 1));
    }
    // f(a, b) by its definition, as a sum over widths
    double mean_mm = 0.0;
    constexpr int widths = 2000;
    for (int k = 0; k < widths; ++k) {
        const double temp_degC = std::min(90.0, 60.0 + 15.0 + 20.0 * (k + 0.5) / widths);
        mean_mm += 4.0 / (1.0 + std::exp(-(temp_degC - 79.0) / 4.5)) / widths;
    }
    EXPECT_NEAR(fod.contraction_mm(90.0, 60.0), mean_mm, 1e-5);
}

}  // namespace
}  // namespace fidservo
