// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings that a rig made without being switched off share their encoder's zero.
#include "gap/links/power_on.h"

#include "core/rig.h"
#include "gap/diagnose.h"
#include "gap/evidence.h"
#include "tests/gap/effects.h"
#include "tests/gap/root_mean_square.h"
#include "tests/gap/simulated_campaign.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using testing::rms;

Recording recorded(std::string_view kind, const Hypothesis& truth = {}) {
    constexpr std::uint64_t seed = 31;
    const std::string name(kind);
    return simulate(reference_rig(), truth, make_experiment(kind, reference_rig(), seed, name), name, seed);
}

/// As written by a rig with controllers of its own whose encoder has another zero.
Recording counted_from(Recording recording, double count) {
    recording.controllers = ControllerNames{"positioner", "positioner"};
    recording.encoder_zero.reset();
    for (StageRow& row : recording.rows) row.encoder_count -= count;
    return recording;
}

/// A part of a recording by its rows.
Recording part(const Recording& whole, std::size_t first, std::size_t end, std::string name) {
    Recording found = whole;
    found.name = std::move(name);
    const auto at = [&](std::size_t row) { return whole.rows.begin() + static_cast<std::ptrdiff_t>(row); };
    found.rows.assign(at(first), at(end));
    std::erase_if(found.detections, [&](const TagDetection& detection) {
        return detection.time_ns < found.rows.front().time_ns ||
               detection.time_ns > found.rows.back().time_ns;
    });
    return found;
}

TEST(Joined, PartsOfARun_AreTheRun) {
    const Recording whole = counted_from(recorded("integrated"), 500.0);
    std::vector<Recording> parts{part(whole, 9000, 20'000, "b"), part(whole, 0, 9000, "a"),
                                 part(whole, 20'000, whole.rows.size(), "c")};
    const auto runs = joined(std::move(parts), reference_rig());
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_EQ(runs[0].name, "a to c");
    ASSERT_EQ(runs[0].rows.size(), whole.rows.size());
    for (std::size_t k = 0; k < whole.rows.size(); ++k) {
        ASSERT_EQ(runs[0].rows[k].time_ns, whole.rows[k].time_ns);
        ASSERT_EQ(runs[0].rows[k].encoder_count, whole.rows[k].encoder_count);
    }
}

TEST(Joined, LongPause_OtherCount_OtherController_StayApart) {
    const Recording whole = counted_from(recorded("integrated"), 500.0);
    const Recording before = part(whole, 0, 9000, "before");
    const auto runs_with = [&](Recording after) {
        return joined({before, std::move(after)}, reference_rig()).size();
    };
    EXPECT_EQ(runs_with(part(whole, 9000, 12'000, "at once")), 1U);
    EXPECT_EQ(runs_with(part(whole, 9099, 12'000, "99 ms later")), 1U);
    EXPECT_EQ(runs_with(part(whole, 9101, 12'000, "101 ms later")), 2U);
    EXPECT_EQ(runs_with(part(whole, 8999, 12'000, "before its end")), 2U);
    EXPECT_EQ(runs_with(counted_from(part(whole, 9000, 12'000, "elsewhere"), 200.0)), 2U);
    Recording other = part(whole, 9000, 12'000, "other controller");
    other.controllers->macro = "nonlinear_pd";
    EXPECT_EQ(runs_with(other), 2U);
    Recording over_other_plate = part(whole, 9000, 12'000, "other plate");
    over_other_plate.plate = {{.id = 1, .centre_mm = {0.0, 0.0}, .side_mm = 1.2}};
    EXPECT_EQ(runs_with(over_other_plate), 2U);
}

TEST(Joined, ARecordingOfTheSameTime_ShowsThatClocksDiffer) {
    const Recording whole = counted_from(recorded("integrated"), 500.0);
    const Recording before = part(whole, 0, 9000, "before"), after = part(whole, 9039, 12'000, "after");
    EXPECT_EQ(joined({before, after, part(whole, 12'500, 20'000, "later")}, reference_rig()).size(), 2U);
    EXPECT_EQ(joined({before, after, part(whole, 8000, 20'000, "same time")}, reference_rig()).size(), 3U);
}

TEST(Joined, RecordingsThatAllBeginAtZero_StayApart) {
    EXPECT_EQ(
        joined({recorded("macro-sweep"), recorded("rest"), recorded("micro-steps")}, reference_rig()).size(),
        3U);
}

class CountedFrom : public ::testing::TestWithParam<double> {};

TEST_P(CountedFrom, TagsTellTheZero_ToTheCount) {
    const Recording homed = recorded("integrated");
    Recording recording = counted_from(homed, GetParam());
    EXPECT_EQ(refer_to_travel(recording, reference_rig()), PlacesFrom::tags);
    for (std::size_t k = 0; k < homed.rows.size(); ++k)
        ASSERT_NEAR(recording.rows[k].encoder_count, homed.rows[k].encoder_count, 1.0);
}

TEST_P(CountedFrom, NoEffect_IsAtTheFloor_AndAScaleIsFoundAsIfHomed) {
    const Hypothesis scale = effects({"encoder_scale:factor=1.01"});
    const Evidence nominal(reference_rig(), {counted_from(recorded("integrated"), GetParam())});
    const Errors none = nominal.errors({}, everything(nominal));
    EXPECT_LT(rms(nominal, none, Signal::tag), 1.1);
    EXPECT_LT(rms(nominal, none, Signal::encoder), 1.1);
    const Evidence scaled(reference_rig(), {counted_from(recorded("integrated", scale), GetParam())});
    EXPECT_LT(rms(scaled, scaled.errors(scale, everything(scaled)), Signal::tag), 1.1);
    EXPECT_GT(rms(scaled, scaled.errors({}, everything(scaled)), Signal::tag), 100.0);
}

INSTANTIATE_TEST_SUITE_P(Zero, CountedFrom, ::testing::Values(-4000.0, -61.0, 1234.0, 3210.0));

TEST(ReferToTravel, HomedRecordings_StayAsTheyAre) {
    for (const char* const truth : {"", "encoder_scale:factor=1.01", "encoder_scale:factor=0.97"})
        for (const char* const kind : {"integrated", "macro-sweep", "macro-pulses"}) {
            const Recording homed = recorded(kind, *truth == '\0' ? Hypothesis{} : effects({truth}));
            Recording recording = homed;
            recording.encoder_zero.reset();
            EXPECT_EQ(refer_to_travel(recording, reference_rig()), PlacesFrom::recording) << kind << truth;
            EXPECT_EQ(recording.rows[7].encoder_count, homed.rows[7].encoder_count);
        }
}

/// As where a file was lost: detections of which nobody can say where the carriage was.
TEST(ReferToTravel, DetectionsWithoutRows_AreOfNoKnownPlace) {
    const Recording whole = recorded("integrated");
    Recording recording = whole;
    recording.rows.clear();
    EXPECT_NO_THROW((void)Evidence(reference_rig(), {recording, whole}));
    recording.encoder_zero.reset();
    ASSERT_FALSE(recording.detections.empty());
    EXPECT_NE(refer_to_travel(recording, reference_rig()), PlacesFrom::tags);
    EXPECT_NO_THROW((void)Evidence(reference_rig(), {recording, whole}));
}

TEST(ReferToTravel, StatedZero_IsTaken_IfItIsKnownToHalfACount) {
    const Recording homed = recorded("integrated");
    Recording recording = counted_from(homed, 700.0);
    recording.encoder_zero = EncoderZero{-700.2, 0.3, "end stop"};
    EXPECT_EQ(refer_to_travel(recording, reference_rig()), PlacesFrom::tags);
    EXPECT_EQ(recording.rows[7].encoder_count, homed.rows[7].encoder_count);
    recording = counted_from(homed, 700.0);
    recording.encoder_zero = EncoderZero{-700.0, 0.0, "by construction"};
    EXPECT_EQ(refer_to_travel(recording, reference_rig()), PlacesFrom::recording);
    EXPECT_EQ(recording.rows[7].encoder_count, homed.rows[7].encoder_count);
    recording = counted_from(homed, 700.0);
    recording.encoder_zero = EncoderZero{-690.0, 6.0, "end stop"};
    EXPECT_EQ(refer_to_travel(recording, reference_rig()), PlacesFrom::tags);
}

/// Without a tag, positions that are counted from the right end are relative, so that no effect at a place is
/// tried.
TEST(SlowUnknownPlaces, EffectsThatActAtAPlace_AreNotDetermined_AndItIsSaid) {
    const auto names_tried = [](const Recording& recording) {
        const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), {recording}));
        std::vector<std::string> names;
        for (const TriedEffect& tried : diagnosis.candidates) names.push_back(tried.effect);
        for (const FoundEffect& found : diagnosis.effects) names.push_back(found.effect);
        return std::pair(names, diagnosis.notes);
    };
    const auto is_said = ::testing::Contains(::testing::HasSubstr("rail_patch, cable_force: not determined"));
    Recording recording = recorded("macro-sweep", effects({"cable_force:stiffness_V_per_mm=0.004"}));
    const auto [known, known_notes] = names_tried(recording);
    EXPECT_THAT(known, ::testing::IsSupersetOf({"rail_patch", "cable_force"}));
    EXPECT_THAT(known_notes, ::testing::Not(is_said));
    recording = counted_from(std::move(recording), 4000.0);
    recording.detections.clear();
    const auto [relative, notes] = names_tried(recording);
    EXPECT_THAT(relative, ::testing::Not(::testing::Contains("rail_patch")));
    EXPECT_THAT(relative, ::testing::Not(::testing::Contains("cable_force")));
    EXPECT_THAT(relative, ::testing::IsSupersetOf({"coulomb_friction", "drive_offset", "cogging"}));
    EXPECT_THAT(notes, is_said);
    EXPECT_THAT(notes, ::testing::Contains(
                           ::testing::HasSubstr("where the carriage is in macro-sweep is not known")));
}

TEST(ReferToTravel, WithoutTags_PlacesBeyondTheTravelAreRelative) {
    const auto reaches = [](double lowest_count, double highest_count) {
        Recording recording;
        for (const double count : {lowest_count, highest_count}) {
            recording.rows.emplace_back();
            recording.rows.back().encoder_count = count;
        }
        return refer_to_travel(recording, reference_rig());
    };
    EXPECT_EQ(reaches(0.0, 4000.0), PlacesFrom::recording);
    EXPECT_EQ(reaches(2000.0, 4069.0), PlacesFrom::recording);  // an encoder whose scale is off
    EXPECT_EQ(reaches(2000.0, 4300.0), PlacesFrom::nowhere);
    EXPECT_EQ(reaches(-200.0, 0.0), PlacesFrom::nowhere);
}

}  // namespace

}  // namespace fidservo
