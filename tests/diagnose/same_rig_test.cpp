// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of recordings that state that they are of two rigs.
#include "src/compare/same_rig.h"

#include "tests/src/temporary_folder.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::compare {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SameRig : public ::testing::Test {
  protected:
    void add(const std::string& recording, const std::string& statements,
             const std::string& rig = "reference-rig") {
        folder_.write(recording + "/recording.yaml", "format: fidservo-recording/1\nname: a\nrig: " + rig +
                                                         "\ntick_s: 0.001\nexperiment: rest\n" + statements);
    }
    std::vector<std::string> notes() const { return notes_on_rigs(folder_ / "A", folder_ / "B"); }

  private:
    testing::TemporaryFolder folder_;
};

TEST_F(SameRig, OneUnitAtTwoTimes_IsNotNoted) {
    add("A/1", "unit: \"P-7\"\nrecorded_at: 2026-11-02T08:15:00Z\nlabels: {site: north}\n");
    add("B/1", "unit: \"P-7\"\nrecorded_at: 2026-11-09T08:15:00Z\nlabels: {site: north}\n");
    EXPECT_THAT(notes(), IsEmpty());
}

TEST_F(SameRig, WhatOnlyOneSetStates_IsNotNoted) {
    add("A/1", "unit: \"P-7\"\nlabels: {batch: \"7\"}\n");
    add("B/1", "labels: {operator: night}\n");
    EXPECT_THAT(notes(), IsEmpty());
}

TEST_F(SameRig, TwoUnits_AreNoted) {
    add("A/1", "unit: \"P-7\"\n");
    add("B/1", "unit: \"P-8\"\n");
    EXPECT_THAT(notes(), ElementsAre(HasSubstr("more than one rig (unit: P-7 in A, P-8 in B)")));
}

TEST_F(SameRig, UnitsMixedWithinTheSets_AreNoted) {
    for (const char* set : {"A", "B"}) {
        add(std::string(set) + "/1", "unit: \"P-7\"\n");
        add(std::string(set) + "/2", "unit: \"P-8\"\n");
    }
    EXPECT_THAT(notes(), ElementsAre(HasSubstr("(unit: P-7, P-8 in A, P-7, P-8 in B)")));
}

TEST_F(SameRig, RigFilesOfTwoNames_AndLabels_AreNoted) {
    add("A/1", "labels: {batch: \"7\", site: north}\n", "rig-2024");
    add("B/1", "labels: {batch: \"8\", site: north}\n", "rig-2025");
    EXPECT_THAT(notes(), ElementsAre(HasSubstr("(rig: rig-2024 in A, rig-2025 in B)"),
                                     HasSubstr("(batch: 7 in A, 8 in B)")));
}

}  // namespace
}  // namespace fidservo::compare
