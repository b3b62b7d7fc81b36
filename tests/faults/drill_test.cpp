// SPDX-License-Identifier: GPL-3.0-or-later
// Every fault of docs/faults.md occurs in a run with the result that the table there states.
#include "tests/faults/drill.h"

#include <cmath>
#include <fstream>
#include <memory>
#include <regex>

#include <gtest/gtest.h>
#include <unistd.h>

namespace fidservo {
namespace {

namespace fs = std::filesystem;
using testing::Drill;
using testing::DrillEnd;

/// A row "| `kind` | what | goes on / stops | `reason` |" of the table.
struct Promise {
    std::string kind;
    bool stops;
    std::string reason;
};

std::vector<Promise> promises() {
    const std::regex row(R"(\| `(\w+)` \|[^|]*\| (goes on|stops)[^|]*\| (?:`([^`]+)`|nothing) \|)");
    std::vector<Promise> table;
    std::ifstream document(FIDSERVO_SOURCE_DIR "/docs/faults.md");
    for (std::string line; std::getline(document, line);)
        if (std::smatch match; std::regex_search(line, match, row))
            table.push_back({match[1], match[2] == "stops", match[3]});
    return table;
}

class SlowDrills : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        drill_ =
            std::make_unique<Drill>(fs::temp_directory_path() / ("drills-" + std::to_string(::getpid())));
    }
    static void TearDownTestSuite() {
        fs::remove_all(drill_->out(""));
        drill_.reset();
    }

    /// From when to when a fault lasts. Dirt goes away after a while, everything else stays.
    static Fault planned(const std::string& kind) {
        Fault fault = parse_fault(kind);
        fault.from_s = drill_->second_visit_s() + 0.05;
        if (fault.kind == FaultKind::tag_hidden) fault.for_s = 3.0;
        return fault;
    }

    static void expect_what_was_measured_is_kept(const std::string& name) {
        const auto whole = testing::text_of_file(drill_->whole() / "journal.jsonl");
        const auto journal = testing::text_of_file(drill_->out(name) / "journal.jsonl");
        const auto first_visit = [](const std::string& text) {
            const auto from = text.find("{\"checkpoint\"", text.find("\"homed\""));
            return text.substr(from, text.find('\n', from) - from);
        };
        EXPECT_EQ(first_visit(journal), first_visit(whole)) << "the site before the fault";
    }

    static void expect_same_within_uncertainty(const fs::path& results) {
        const auto whole = testing::measured_rows(drill_->whole() / "results.csv");
        const auto rows = testing::measured_rows(results);
        ASSERT_EQ(rows.size(), whole.size());
        for (const auto& [key, row] : rows) {
            SCOPED_TRACE(key);
            ASSERT_TRUE(whole.contains(key));
            EXPECT_NE(row.verdict, "not_measured");
            const auto& expected = whole.at(key);
            if (!row.value || !row.uncertainty) continue;
            EXPECT_NEAR(*row.value, *expected.value,
                        5.0 * std::hypot(*row.uncertainty, *expected.uncertainty));
        }
    }

    static bool has_interrupted_recording(const fs::path& folder) {
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().filename().string().ends_with(".interrupted-1") &&
                fs::file_size(entry.path() / "stage0/data.csv") > 0)
                return true;
        return false;
    }

    static inline std::unique_ptr<Drill> drill_;
};

TEST_F(SlowDrills, EveryFault_EndsAsTheTableSays) {
    const auto table = promises();
    ASSERT_EQ(table.size(), fault_kinds.size()) << "docs/faults.md has a row for every kind";
    for (const Promise& promise : table) {
        SCOPED_TRACE(promise.kind);
        const DrillEnd end = drill_->run(promise.kind, {planned(promise.kind)});
        EXPECT_EQ(end.stopped, promise.stops) << end.text.substr(0, 2000);
        EXPECT_NE(end.text.find(promise.reason), std::string::npos) << end.text.substr(0, 2000);
        EXPECT_TRUE(end.outputs_zero);
        expect_what_was_measured_is_kept(promise.kind);
        if (!end.stopped) {
            expect_same_within_uncertainty(drill_->out(promise.kind) / "results.csv");
            continue;
        }
        EXPECT_NE(end.text.find("--resume goes on from here"), std::string::npos);
        const DrillEnd resumed = drill_->resume(promise.kind);
        EXPECT_FALSE(resumed.stopped) << resumed.text.substr(0, 2000);
        EXPECT_EQ(testing::text_of_file(drill_->out(promise.kind) / "results.csv"),
                  testing::text_of_file(drill_->whole() / "results.csv"));
        EXPECT_TRUE(has_interrupted_recording(drill_->out(promise.kind) / "recordings"))
            << "what was recorded until the fault is kept";
    }
}

/// A fault before the rig's position is known.
TEST_F(SlowDrills, EveryFaultThatStopsARun_IsNamedInHomingToo) {
    for (const Promise& promise : promises()) {
        if (!promise.stops) continue;
        SCOPED_TRACE(promise.kind);
        const std::string name = promise.kind + "_at_once";
        const DrillEnd end = drill_->run_from_start(name, {parse_fault(promise.kind)});
        EXPECT_TRUE(end.stopped);
        EXPECT_NE(end.text.find("homing: "), std::string::npos) << end.text.substr(0, 2000);
        EXPECT_NE(testing::text_of_file(drill_->out(name) / "recordings/homing/recording.yaml")
                      .find("finished: false"),
                  std::string::npos);
        EXPECT_NE(end.text.find(promise.reason), std::string::npos) << end.text.substr(0, 2000);
        EXPECT_TRUE(end.outputs_zero);
    }
    const DrillEnd resumed = drill_->resume("macro_jammed_at_once");
    EXPECT_FALSE(resumed.stopped) << resumed.text.substr(0, 2000);
    EXPECT_EQ(testing::text_of_file(drill_->out("macro_jammed_at_once") / "results.csv"),
              testing::text_of_file(drill_->whole() / "results.csv"));
}

TEST_F(SlowDrills, CameraThatIsWaitedFor_TheRunGoesOnWhenItIsBack) {
    Fault away = planned("camera_silent");
    away.for_s = 4.0;
    const DrillEnd end = drill_->run_waiting_for_the_camera("waited", {away});
    EXPECT_FALSE(end.stopped) << end.text.substr(0, 2000);
    EXPECT_EQ(end.text.find("deferred"), std::string::npos) << "it was waited for at the site";
    expect_same_within_uncertainty(drill_->out("waited") / "results.csv");
    away.for_s = 60.0;
    const DrillEnd too_long = drill_->run_waiting_for_the_camera("waited_for_long", {away});
    EXPECT_TRUE(too_long.stopped);
    EXPECT_NE(too_long.text.find("no frame from the camera for 11."), std::string::npos)
        << too_long.text.substr(0, 2000);
    EXPECT_TRUE(too_long.outputs_zero);
}

/// Other sites are not affected.
TEST_F(SlowDrills, TagOfAnotherSite_ThatSiteIsNotMeasuredAndTheOthersAre) {
    const DrillEnd end = drill_->run_with_wrong_tag("wrong_tag");
    EXPECT_FALSE(end.stopped) << end.text.substr(0, 2000);
    EXPECT_TRUE(end.outputs_zero);
    EXPECT_NE(end.text.find("tag 52 is expected, seen: "), std::string::npos);
    EXPECT_EQ(end.text.find("registered anew"), std::string::npos) << end.text.substr(0, 2000);
    for (const auto& [key, row] : testing::measured_rows(drill_->out("wrong_tag") / "results.csv"))
        EXPECT_EQ(row.verdict, key.starts_with("52,") ? "not_measured" : "pass") << key;
}

}  // namespace
}  // namespace fidservo
