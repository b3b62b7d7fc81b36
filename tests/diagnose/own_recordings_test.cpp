// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings of a nominal simulated rig in normal use have no gap.
#include "src/files/rig/rig_file.h"
#include "tests/control_guardian/child_process.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo {
namespace {

using testing::ChildProcess;
using testing::TemporaryFolder;

nlohmann::json json_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return nlohmann::json::parse(stream);
}

/// The diagnosis that `fidservo diagnose` writes for recordings.
nlohmann::json diagnosis_of(const std::filesystem::path& recordings, const std::filesystem::path& json,
                            const std::filesystem::path& rig_file = reference_rig_file()) {
    ChildProcess program({FIDSERVO_PROGRAM, "diagnose", "--rig", rig_file.string(), recordings.string(),
                          "--json", json.string()});
    EXPECT_EQ(program.wait(), 0) << program.output();
    return json_of(json);
}

/// The entry of a signal; empty if it was not judged.
nlohmann::json signal_of(const nlohmann::json& diagnosis, const std::string& name) {
    for (const auto& signal : diagnosis.at("signals"))
        if (signal.at("signal") == name) return signal;
    return {};
}

void expect_no_gap(const nlohmann::json& diagnosis) {
    EXPECT_EQ(diagnosis.at("verdict"), "no-gap") << diagnosis.dump(2);
    EXPECT_EQ(diagnosis.at("ended"), "finished");
    EXPECT_LT(diagnosis.at("gap").at("before"), 1.1);
    EXPECT_FALSE(signal_of(diagnosis, "tag").is_null());
}

TEST(SlowOwnRecordings, Inspection_HasNoGap_AndSaysSoItself) {
    const TemporaryFolder folder;
    const std::filesystem::path run = folder / "run";
    const std::string recipe = FIDSERVO_ASSETS_DIR "/demo/recipe.yaml";
    ChildProcess program({FIDSERVO_PROGRAM, "inspect", recipe, "--out", run.string()});
    EXPECT_TRUE(program.output_ends(std::chrono::minutes(5)));
    EXPECT_LE(program.wait(), 1) << program.output();  // 1: the demo plate has flaws
    EXPECT_NE(program.output().find("rig: no-gap"), std::string::npos);
    expect_no_gap(json_of(run / "diagnosis.json"));
    EXPECT_TRUE(std::filesystem::exists(run / "diagnosis.html"));
    expect_no_gap(diagnosis_of(run, folder / "whole.json"));
    // The second site's recording alone begins in mid-work: encoder and tags are judged.
    const nlohmann::json site = diagnosis_of(run / "recordings" / "site-017", folder / "site.json");
    EXPECT_EQ(site.at("verdict"), "no-gap") << site.dump(2);
    EXPECT_FALSE(signal_of(site, "encoder").is_null());
}

/// Runs a command that drives the simulated rig and records it.
void record(std::vector<std::string> arguments, const std::filesystem::path& out) {
    arguments.insert(arguments.begin(), FIDSERVO_PROGRAM);
    arguments.insert(arguments.end(), {"--out", out.string()});
    ChildProcess program(arguments);
    EXPECT_TRUE(program.output_ends(std::chrono::minutes(2)));
    EXPECT_EQ(program.wait(), 0) << program.output();
}

std::size_t count_in(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
}

TEST(SlowOwnRecordings, InspectionOfAPlateThatTheRigFileHasNot_IsJudgedByItsTags) {
    const TemporaryFolder folder;
    const auto recipe = folder.write("recipe.yaml",
                                     "name: shifted\n"
                                     "plate:\n"
                                     "  grid: { columns: 80, rows: 1, pitch_mm: [2.0, 0.0], first_id: 200, "
                                     "origin_mm: [0.6, 0.1], side_mm: 1.0 }\n"
                                     "sites: { tags: { first: 203, step: 8, count: 3 } }\n"
                                     "views:\n"
                                     "  - { name: right, offset_um: 1000, checks: [ fiducial_placement: { "
                                     "tolerance_um: 10 } ] }\n");
    const std::filesystem::path run = folder / "run";
    record({"inspect", recipe.string()}, run);
    expect_no_gap(json_of(run / "diagnosis.json"));
    EXPECT_EQ(count_in(testing::text_of(run / "report.html"), "<section id=\"rig\">"), 1U);
    expect_no_gap(diagnosis_of(run, folder / "run.json"));
    for (const auto& recording : std::filesystem::directory_iterator(run / "recordings"))
        std::filesystem::remove(recording.path() / "plate.yaml");
    const nlohmann::json without = diagnosis_of(run, folder / "without.json");
    EXPECT_TRUE(signal_of(without, "tag").is_null()) << "the rig file has no such tags";
}

TEST(SlowOwnRecordings, StageCalibration_HasNoGap) {
    const TemporaryFolder folder;
    const std::filesystem::path run = folder / "calibrated";
    ChildProcess program({FIDSERVO_PROGRAM, "calibrate", "stage", "--out", run.string()});
    EXPECT_EQ(program.wait(), 0) << program.output();
    expect_no_gap(diagnosis_of(run, folder / "diagnosis.json"));
}

TEST(SlowOwnRecordings, GotoAndHome_HaveNoGap) {
    const TemporaryFolder folder;
    record({"goto", "--tag", "12", "--dx-um", "100", "--hold", "5"}, folder / "goto");
    expect_no_gap(diagnosis_of(folder / "goto", folder / "goto.json"));
    record({"home"}, folder / "home");
    EXPECT_EQ(diagnosis_of(folder / "home", folder / "home.json").at("verdict"), "no-gap");
}

TEST(SlowOwnRecordings, GotoOnARigWhoseHallSensorHasAnotherGain_SaysSo) {
    const TemporaryFolder folder;
    const std::filesystem::path assets = FIDSERVO_ASSETS_DIR;
    std::filesystem::copy_file(assets / "preisach_fod.csv", folder / "preisach_fod.csv");
    const auto truth = folder.write("truth.yaml", testing::text_of(assets / "rig.yaml") +
                                                      "\neffects:\n  - { name: hall_gain, factor: 1.1 }\n");
    record({"goto", "--tag", "12", "--dx-um", "100", "--hold", "5", "--sim-rig", truth.string()},
           folder / "goto");
    const nlohmann::json diagnosis = diagnosis_of(folder / "goto", folder / "goto.json");
    ASSERT_FALSE(diagnosis.at("effects").empty()) << diagnosis.dump(2);
    EXPECT_EQ(diagnosis.at("effects").front().at("effect"), "hall_gain");
}

/// A folder of shared/cases.
class SharedCase : public ::testing::Test {
  protected:
    void find(const std::string& name) {
        folder_ = std::filesystem::path(FIDSERVO_DATA_DIR).parent_path() / "cases" / name;
        if (!std::filesystem::exists(folder_)) GTEST_SKIP() << "no shared data at " << folder_;
    }

    std::filesystem::path folder_;
    TemporaryFolder out_;
};

TEST_F(SharedCase, SetpointOnATieOfTheRounding_IsNoGap) {
    find("21-setpoint-on-a-tie");
    if (IsSkipped()) return;
    const nlohmann::json diagnosis = diagnosis_of(folder_ / "macro-square-1", out_ / "diagnosis.json");
    EXPECT_EQ(diagnosis.at("verdict"), "no-gap") << diagnosis.dump(2);
    EXPECT_LT(signal_of(diagnosis, "macro_command").at("before"), 1e-4);
}

class SlowSharedCase : public SharedCase {};

/// The data show friction in one direction only, and the errors are larger than any effect of the catalogue
/// explains.
TEST_F(SlowSharedCase, MotorOfOthers_IsAnsweredInTime_WithFrictionAmongWhatItCannotTellApart) {
    find("19-motor-of-others");
    if (IsSkipped()) return;
    const nlohmann::json diagnosis = diagnosis_of(folder_, out_ / "diagnosis.json", folder_ / "rig.yaml");
    ASSERT_FALSE(diagnosis.at("effects").empty());
    EXPECT_GT(diagnosis.at("effects").back().at("gap_removed"), 0.99);
    std::vector<std::string> named;
    for (const nlohmann::json& effect : diagnosis.at("effects")) {
        named.push_back(effect.at("effect"));
        for (const std::string other : effect.at("indistinguishable_from")) named.push_back(other);
    }
    EXPECT_NE(std::ranges::find(named, "coulomb_friction"), named.end()) << diagnosis.at("effects").dump(2);
}

/// Slow, because under sanitizers the time ends before the search has started.
TEST_F(SlowSharedCase, MotorOfOthers_SignalEndsItWithTheBestUntilThen) {
    find("19-motor-of-others");
    if (IsSkipped()) return;
    const std::filesystem::path json = out_ / "diagnosis.json";
    ChildProcess program({FIDSERVO_PROGRAM, "diagnose", "--rig", (folder_ / "rig.yaml").string(),
                          folder_.string(), "--json", json.string()});
    EXPECT_TRUE(program.prints(" of at most "));
    program.send(SIGTERM);
    EXPECT_TRUE(program.output_ends());
    EXPECT_EQ(program.wait(), 0) << program.output();
    EXPECT_EQ(json_of(json).at("ended"), "interrupted");
    EXPECT_NE(program.output().find("ended: interrupted"), std::string::npos);
}

}  // namespace
}  // namespace fidservo
