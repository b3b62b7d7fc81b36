// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/files/recording/reader.h"
#include "src/session/faulty_devices.h"
#include "src/session/pilot.h"
#include "tests/session/watched_rig.h"
#include "tests/src/temporary_folder.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

std::shared_ptr<SimulatedRig> reference_rig_in_simulation() {
    return std::make_shared<SimulatedRig>(
        reference_physics(), load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml").camera.value(), reference_plate(), 5);
}

/// A session on that rig with a fault of the stage.
Session session_with(const std::shared_ptr<SimulatedRig>& rig, const Fault& fault) {
    const auto stage = std::make_shared<FaultyStage>(std::make_shared<SimulatedStage>(rig, nullptr),
                                                     std::vector<Fault>{fault});
    return {SessionOptions{}, load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml"), reference_plate(),
            Devices{stage, std::make_shared<SimulatedCamera>(rig)}};
}

/// The reference rig with a session that has homed it, seed 5. Homing is done once in a process, and
/// restored.
/// @param printed  as the reference plate where homing looks at it
std::unique_ptr<WatchedRig> homed_rig(const Plate& printed = reference_plate()) {
    static const auto homed = [] {
        WatchedRig rig(reference_physics(), reference_plate(), 5);
        const auto end = rig.session.home();
        EXPECT_TRUE(end) << end.error().text;
        return std::pair(rig.rig->snapshot(), rig.session.checkpoint());
    }();
    auto rig = std::make_unique<WatchedRig>(reference_physics(), printed, 5);
    rig->rig->restore(homed.first);
    rig->session.restore(homed.second);
    return rig;
}

TEST(Session, Home_FindsWhereTheCameraIs) {
    const auto rig = homed_rig();
    const auto arrival = rig->session.go_to(3, 0.25);
    ASSERT_TRUE(arrival) << arrival.error().text;
    EXPECT_NEAR(plant::camera_position_mm(rig->rig->truth()), 6.25, 0.002);
    EXPECT_NEAR(rig->session.camera_mm().x(), plant::camera_position_mm(rig->rig->truth()), 0.0005);
}

TEST(SlowSession, PlatesOfOtherTags_AreMeasuredAsWell) {
    const auto off_mm = [](const TagPrint& print) {
        Rig of = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
        of.fiducials->print = print;
        of.fiducials->side_mm = 1.5 / print.share_with_zone();  // all that is printed fits the pitch
        of.fiducials->columns = 20;
        WatchedRig rig(reference_physics(), plate_of(*of.fiducials), 5, of);
        const auto homed = rig.session.home();
        EXPECT_TRUE(homed) << text_of(print) << ": " << homed.error().text;
        if (!homed) return 1.0;
        const auto arrival = rig.session.go_to(3, 0.25);
        EXPECT_TRUE(arrival) << text_of(print) << ": " << arrival.error().text;
        if (!arrival) return 1.0;
        return std::abs(rig.session.camera_mm().x() - plant::camera_position_mm(rig.rig->truth()));
    };
    for (const TagPrint& print :
         {TagPrint{find_tag_family("tag25h9")}, TagPrint{find_tag_family("tagStandard41h12")},
          TagPrint{find_tag_family("DICT_4X4_50"), 2, true}})
        EXPECT_LT(off_mm(print), 0.0005) << text_of(print);
}

TEST(SlowSession, HomingThatIsRecorded_StatesWhereTheEncoderCountsFrom) {
    WatchedRig rig(reference_physics(), reference_plate(), 5);
    const testing::TemporaryFolder folder;
    rig.session.record_to(folder / "homing", "homing");
    EXPECT_FALSE(read_recording(folder / "homing").encoder_zero) << "not known yet";
    ASSERT_TRUE(rig.session.home());
    ASSERT_TRUE(rig.session.end_recording());
    const Recording recording = read_recording(folder / "homing");
    ASSERT_TRUE(recording.encoder_zero && recording.controllers);
    EXPECT_NEAR(recording.encoder_zero->count, -static_cast<double>(rig.rig->truth().encoder.origin_count),
                1.0);
    EXPECT_EQ(recording.encoder_zero->how.find("end stop, then tag "), 0u) << recording.encoder_zero->how;
    EXPECT_EQ(recording.controllers->macro, "positioner");
    EXPECT_EQ(recording.controllers->micro, "positioner");
    std::vector<std::string> what;
    for (const RecordingEvent& event : recording.events) what.push_back(event.what);
    EXPECT_EQ(what, (std::vector<std::string>{"homing", "end_stop", "registered", "homing"}));
    EXPECT_EQ(recording.events.back().text, "ended");
}

TEST(Session, DetectionsThatAreRecorded_AreRefined_AndSayHowWellTheyAreKnown) {
    const auto rig = homed_rig();
    const testing::TemporaryFolder folder;
    rig->session.record_to(folder / "a", "goto");
    ASSERT_TRUE(rig->session.go_to(3, 0.25));
    ASSERT_TRUE(rig->session.end_recording());
    const Recording recording = read_recording(folder / "a");
    ASSERT_FALSE(recording.detections.empty());
    EXPECT_TRUE(recording.plate.empty()) << "the plate is the rig file's";
    for (const TagDetection& detection : recording.detections) {
        EXPECT_EQ(detection.is_refined, true);
        ASSERT_TRUE(detection.covariances_px2);
        for (const Eigen::Matrix2d& corner_px2 : *detection.covariances_px2) {
            EXPECT_GT(corner_px2.determinant(), 0.0);
            EXPECT_LT(std::sqrt(corner_px2.trace()), 0.1);
        }
    }
}

TEST(Session, CameraThatFails_IsAnEventOfARecordingThatIsUnfinished) {
    const testing::TemporaryFolder folder;
    {
        const auto rig = reference_rig_in_simulation();
        const auto camera = std::make_shared<FaultyCamera>(
            std::make_shared<SimulatedCamera>(rig), std::vector<Fault>{{FaultKind::camera_silent, 0.2}});
        Session session({}, load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml"), reference_plate(),
                        Devices{std::make_shared<SimulatedStage>(rig, nullptr), camera});
        session.record_to(folder / "rest", "rest");
        ASSERT_FALSE(session.observe(3.0));
    }
    const Recording recording = read_recording(folder / "rest");
    EXPECT_TRUE(recording.is_unfinished);
    EXPECT_GT(recording.rows.size(), 1000u);
    ASSERT_EQ(recording.events.size(), 1u);
    EXPECT_EQ(recording.events[0].what, "fault");
    EXPECT_NE(recording.events[0].text.find("no frame from the camera"), std::string::npos);
}

/// A carriage at rest looks like one at its end stop.
TEST(Session, Home_CarriageJams_IsSaidWhereverItIsOnItsWay) {
    for (const double from_s : {0.0, 0.4, 0.9}) {
        SCOPED_TRACE(from_s);
        const auto rig = reference_rig_in_simulation();
        const testing::TemporaryFolder folder;
        Session session = session_with(rig, {FaultKind::macro_jammed, from_s});
        session.record_to(folder / "homing", "homing");
        const auto homed = session.home();
        session.leave_recording();
        ASSERT_FALSE(homed);
        EXPECT_FALSE(read_recording(folder / "homing").encoder_zero) << "nothing has shown where it is";
        EXPECT_EQ(homed.error().reason, Reason::device);
        EXPECT_NE(homed.error().text.find("the macro stage does not answer"), std::string::npos)
            << homed.error().text;
        EXPECT_GT(plant::camera_position_mm(rig->truth()), 10.0) << "the end stop was not reached";
    }
}

/// The carriage can still move, and a tag shows its position.
TEST(SlowSession, Home_SomethingInTheWay_IsRegisteredAllTheSame) {
    const auto rig = reference_rig_in_simulation();
    Session session = session_with(rig, {FaultKind::macro_jammed, 0.5, 0.3});
    const auto homed = session.home();
    ASSERT_TRUE(homed) << homed.error().text;
    EXPECT_GT(rig->truth().axis.position_mm, 10.0) << "the end stop was not reached";
    ASSERT_TRUE(session.go_to(40, 0.25));
    EXPECT_NEAR(plant::camera_position_mm(rig->truth()), 80.25, 0.002);
}

TEST(Session, DamagedCheckpoint_IsRefused) {
    WatchedRig rig(reference_physics(), reference_plate(), 5);
    for (const char* text : {"", "{}", R"({"heater": 3})", R"({"heater": {}, "stroke_scale": "x"})"})
        EXPECT_THROW(rig.session.restore(text), InputError) << text;
}

TEST(SlowSession, SameSeed_SameCommands) {
    const auto run = [] {
        WatchedRig rig(reference_physics(), reference_plate(), 9);
        EXPECT_TRUE(rig.session.home());
        EXPECT_TRUE(rig.session.go_to(5, 0.1));
        return rig.stage->commands;
    };
    const auto first = run(), second = run();
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
        ASSERT_EQ(first[k].macro_V, second[k].macro_V);
        ASSERT_EQ(first[k].micro_V, second[k].micro_V);
    }
}

TEST(Session, End_LeavesBothCommandsZero) {
    auto rig = homed_rig();
    ASSERT_TRUE(rig->session.hold(0.1));
    const auto stage = rig->stage;
    EXPECT_GT(stage->commands.back().micro_V, 1.3);
    rig.reset();
    EXPECT_EQ(stage->commands.back().micro_V, 0.0);
    EXPECT_EQ(stage->commands.back().macro_V, 0.0);
}

TEST(SlowSession, CheckpointRestoredInANewSession_GoesOnBitForBit) {
    const auto physics = reference_physics();
    WatchedRig first(physics, reference_plate(), 11);
    ASSERT_TRUE(first.session.home());
    ASSERT_TRUE(first.session.go_to(7, -0.3));
    const std::string rig_state = first.rig->snapshot(), checkpoint = first.session.checkpoint();
    const testing::TemporaryFolder folder;
    first.session.record_to(folder / "first", "");
    const auto expected = first.session.go_to(40, 0.2);
    ASSERT_TRUE(expected);
    ASSERT_TRUE(first.session.end_recording());

    WatchedRig second(physics, reference_plate(), 11);
    second.rig->restore(rig_state);
    second.session.restore(checkpoint);
    second.session.record_to(folder / "second", "");
    const auto again = second.session.go_to(40, 0.2);
    ASSERT_TRUE(again);
    ASSERT_TRUE(second.session.end_recording());
    for (const char* file : {"stage0/data.csv", "cam0/detections.csv"})
        EXPECT_EQ(testing::text_of(folder / "first" / file), testing::text_of(folder / "second" / file))
            << file;
    EXPECT_EQ(again->reached_dx_um, expected->reached_dx_um);
    EXPECT_EQ(plant::camera_position_mm(second.rig->truth()), plant::camera_position_mm(first.rig->truth()));
}

TEST(Session, PlateWithoutTheTag_FailsWithAReasonAndStaysSafe) {
    Plate printed = reference_plate();
    std::erase_if(printed.tags, [](const PlateTag& tag) { return tag.id >= 28 && tag.id <= 32; });
    const auto rig = homed_rig(printed);
    const auto arrival = rig->session.go_to(30, 0.0);
    ASSERT_FALSE(arrival);
    EXPECT_TRUE(arrival.error().reason == Reason::no_tag || arrival.error().reason == Reason::wrong_tag)
        << arrival.error().text;
    EXPECT_TRUE(rig->session.go_to(10, 0.0));
}

TEST(SlowSession, TagsThatChangedPlaces_LeadTheCameraNotAstray) {
    Plate printed = reference_plate();
    std::swap(printed.tags[30].id, printed.tags[80].id);
    const auto rig = homed_rig(printed);
    const auto arrival = rig->session.go_to(30, 0.0);
    ASSERT_FALSE(arrival);
    EXPECT_EQ(arrival.error().reason, Reason::wrong_tag) << arrival.error().text;
    EXPECT_NEAR(rig->session.pilot().believed_s_mm(), plant::camera_position_mm(rig->rig->truth()), 0.1);
    EXPECT_TRUE(rig->session.go_to(32, 0.0));
}

TEST(SlowSession, CountsThatWereNoMotion_AreFoundOutByTheTags) {
    const auto rig = reference_rig_in_simulation();
    Session session = session_with(rig, {FaultKind::encoder_jump, 9.0});
    ASSERT_TRUE(session.home());
    ASSERT_LT(session.now_s(), 9.0) << "the counts jump after homing";
    ASSERT_TRUE(session.hold(1.0));
    const auto arrival = session.go_to(40, 0.25);
    ASSERT_TRUE(arrival) << arrival.error().text;
    EXPECT_NEAR(plant::camera_position_mm(rig->truth()), 80.25, 0.002);
    EXPECT_TRUE(session.check_rig());
}

/// The PD then oscillates by a count for ever.
TEST(SlowSession, DriveThatActsLate_IsHomedAndPositioned) {
    auto physics = reference_physics();
    const plant::EffectSetting late = plant::parse_effect("drive_delay:delay_ms=5");
    plant::apply_effects(physics, {&late, 1});
    WatchedRig rig(physics, reference_plate(), 5);
    const auto homed = rig.session.home();
    ASSERT_TRUE(homed) << homed.error().text;
    for (const int tag : {3, 40}) {
        const auto arrival = rig.session.go_to(tag, 0.25);
        ASSERT_TRUE(arrival) << arrival.error().text;
        EXPECT_NEAR(plant::camera_position_mm(rig.rig->truth()), 2.0 * tag + 0.25, 0.002);
    }
}

TEST(Session, TagOutOfTravelOrNotOnThePlate_IsRefused) {
    const auto rig = homed_rig();
    EXPECT_EQ(rig->session.go_to(100, 5.0).error().reason, Reason::out_of_reach);
    EXPECT_EQ(rig->session.go_to(500, 0.0).error().reason, Reason::wrong_tag);
}

}  // namespace
}  // namespace fidservo
