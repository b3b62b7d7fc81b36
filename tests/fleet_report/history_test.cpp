// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/inspect/report/rig_history.h"
#include "tests/fleet_report/drawn_fleet.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo::inspect {
namespace {

RigFindings run_with(double floors, std::uint64_t seed) {
    fleet::DrawnFleet drawn;
    drawn.seed = seed;
    drawn.units = drawn.weeks = 1;
    drawn.spread_floors = 0.0;
    drawn.truth = [=](std::size_t effect, std::size_t, std::size_t) { return effect == 1 ? floors : 0.0; };
    const auto json = nlohmann::json::parse(fleet::file_text(fleet::draw(drawn).front()));
    return {"", "", json["diagnosis"].dump()};
}

/// A run a day.
RecordingOrigin day(std::uint64_t run, const std::string& unit = {}) {
    RecordingOrigin origin;
    origin.unit = unit;
    origin.recorded_at =
        fleet::date_of(1'772'409'600 + 86'400 * static_cast<std::int64_t>(run)) + "T08:00:00Z";
    return origin;
}

bool warns(const HistoryFindings& said) {
    return std::ranges::any_of(said.lines,
                               [](const std::string& line) { return line.starts_with("warning: "); });
}

TEST(RigHistory, EachRun_IsALine) {
    const fidservo::testing::TemporaryFolder folder;
    const Rig rig = load_rig(reference_rig_file());
    for (std::uint64_t run = 0; run < 3; ++run)
        EXPECT_FALSE(warns(append_to_history(folder / "h", rig, "sha", run_with(2.0, run), day(run))));
    const std::string text = fidservo::testing::text_of(folder / "h");
    EXPECT_EQ(std::ranges::count(text, '\n'), 3);
}

TEST(RigHistory, LineCutShort_IsPassedOverAndSaid) {
    const fidservo::testing::TemporaryFolder folder;
    const Rig rig = load_rig(reference_rig_file());
    (void)append_to_history(folder / "h", rig, "sha", run_with(2.0, 1), day(1));
    std::ofstream(folder / "h", std::ios::app) << R"({"format": "fidservo-fleet-res)";
    const HistoryFindings said = append_to_history(folder / "h", rig, "sha", run_with(2.0, 2), day(2));
    EXPECT_NE(said.lines.front().find("line 2: is no whole JSON file"), std::string::npos);
    EXPECT_NE(said.lines.back().find("(2 runs of "), std::string::npos);
}

TEST(RigHistory, NothingDiagnosed_AppendsNothing) {
    const fidservo::testing::TemporaryFolder folder;
    (void)append_to_history(folder / "h", load_rig(reference_rig_file()), "sha", {"", "", ""}, day(0));
    EXPECT_FALSE(std::filesystem::exists(folder / "h"));
}

TEST(RigHistory, RigThatJumps_IsWarnedOf) {
    const fidservo::testing::TemporaryFolder folder;
    const Rig rig = load_rig(reference_rig_file());
    bool warned = false;
    for (std::uint64_t run = 0; run < 24; ++run) {
        const bool now = warns(
            append_to_history(folder / "h", rig, "sha", run_with(run < 12 ? 2.0 : 9.0, 40 + run), day(run)));
        EXPECT_FALSE(now && run < 12) << "run " << run;
        warned = warned || now;
    }
    EXPECT_TRUE(warned);
}

TEST(RigHistory, UnitsOfOneFile_AreToldApart) {
    const fidservo::testing::TemporaryFolder folder;
    const Rig rig = load_rig(reference_rig_file());
    HistoryFindings steady, jumping;
    for (std::uint64_t run = 0; run < 24; ++run) {
        steady = append_to_history(folder / "h", rig, "sha", run_with(2.0, 80 + run), day(run, "P-1"));
        jumping = append_to_history(folder / "h", rig, "sha", run_with(run < 12 ? 2.0 : 9.0, 40 + run),
                                    day(run, "P-2"));
    }
    EXPECT_FALSE(warns(steady));
    EXPECT_TRUE(warns(jumping));
    EXPECT_NE(jumping.lines.back().find("(24 runs of P-2)"), std::string::npos);
}

}  // namespace
}  // namespace fidservo::inspect
