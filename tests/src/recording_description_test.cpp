// SPDX-License-Identifier: GPL-3.0-or-later
// What recording.yaml states, and recordings whose writer was ended in the middle.
#include "core/input_error.h"
#include "src/files/recording/description.h"
#include "src/files/recording/reader.h"
#include "src/files/recording/writer.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

const std::filesystem::path archive = FIDSERVO_ARCHIVE_DIR;

constexpr const char* five_keys =
    "format: fidservo-recording/1\nname: a\nrig: reference-rig\ntick_s: 0.001\nexperiment: rest\n";

/// The reader's message on five keys and more, without the file's path.
std::string message_on(const std::string& more) {
    const TemporaryFolder folder;
    const auto file = folder.write("recording.yaml", five_keys + more);
    return message_of([&] { read_recording(folder.path()); }).substr(file.string().size());
}

Recording read_with(const std::string& more) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", five_keys + more);
    return read_recording(folder.path());
}

RecordingOptions options_named(const std::string& name) {
    RecordingOptions options;
    options.name = name;
    options.rig = "r";
    options.experiment = "rest";
    options.columns.encoder = true;
    return options;
}

TEST(RecordingDescription, EveryKey_IsWrittenAndRead) {
    const TemporaryFolder folder;
    RecordingOptions options = options_named("a");
    options.encoder_zero = EncoderZero{-3210.25, 0.3, "end stop, then tag 5"};
    options.controllers = ControllerNames{"benchmark_pid", "pi_antiwindup"};
    options.origin = {"comedi:/dev/comedi0", "sim", "fidservo 0.1.0 (64c8409)"};
    RecordingWriter writer(folder / "a", options);
    EXPECT_NE(text_of(folder / "a/recording.yaml").find("finished: false\n"), std::string::npos);
    writer.add({200, "fault", "the \"wire\": too hot # \xc2\xb5\nat once"});
    writer.add({100, "homing", ""});
    writer.set_encoder_zero({-3210.5, 0.25, "tag 7"});
    ASSERT_TRUE(writer.close());

    const Recording read = read_recording(folder / "a");
    ASSERT_TRUE(read.encoder_zero && read.controllers);
    EXPECT_EQ(read.encoder_zero->count, -3210.5);
    EXPECT_EQ(read.encoder_zero->std_count, 0.25);
    EXPECT_EQ(read.encoder_zero->how, "tag 7");
    EXPECT_EQ(read.controllers->macro, "benchmark_pid");
    EXPECT_EQ(read.controllers->micro, "pi_antiwindup");
    EXPECT_FALSE(read.is_unfinished);
    ASSERT_EQ(read.events.size(), 2u);
    EXPECT_EQ(read.events[0].time_ns, 100);
    EXPECT_EQ(read.events[0].what, "homing");
    EXPECT_EQ(read.events[0].text, "");
    EXPECT_EQ(read.events[1].text, "the \"wire\": too hot # \xc2\xb5\nat once");
    const std::string text = text_of(folder / "a/recording.yaml");
    for (const char* line : {"stage: comedi:/dev/comedi0\n", "camera: sim\n",
                             "program: fidservo 0.1.0 (64c8409)\n", "finished: true\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

TEST(RecordingDescription, RecordingInMemory_KeepsWhatItStates) {
    const TemporaryFolder folder;
    const Recording first = read_recording(archive / "with-origin");
    write_recording(folder / "copy", first, std::nullopt);
    const Recording copy = read_recording(folder / "copy");
    EXPECT_EQ(copy.encoder_zero->count, first.encoder_zero->count);
    EXPECT_EQ(copy.controllers->micro, first.controllers->micro);
    EXPECT_EQ(copy.events.size(), first.events.size());
}

TEST(RecordingDescription, NothingStated_IsEmptyAndFinished) {
    const Recording read = read_with("");
    EXPECT_FALSE(read.encoder_zero || read.controllers || read.is_unfinished);
    EXPECT_TRUE(read.events.empty());
}

TEST(RecordingDescription, Controllers_ByNameOrWithTheirNumbers) {
    const Recording read = read_with(
        "controllers:\n  macro: { name: nonlinear_pd, e0_V_per_count: 0.0124593, friction_V: 3 }\n"
        "  micro: positioner\n");
    EXPECT_EQ(read.controllers->macro, "nonlinear_pd");
    EXPECT_EQ(read.controllers->micro, "positioner");
    EXPECT_EQ(read_with("controllers: { micro: pi_antiwindup }\n").controllers->macro, "");
}

TEST(RecordingDescription, Misuse_GetsOneLine) {
    EXPECT_EQ(message_on("encoder_zero: 3\n"), ":6: encoder_zero: 3: must be a map of keys and values");
    EXPECT_EQ(message_on("encoder_zero: { count: 3 }\n"),
              ":6: encoder_zero.std_count: missing: this key must be given, in count");
    EXPECT_EQ(message_on("encoder_zero: { count: x, std_count: 0 }\n"),
              ":6: encoder_zero.count: x: must be a number");
    EXPECT_EQ(message_on("encoder_zero: { count: 3, std_count: -1 }\n"),
              ":6: encoder_zero.std_count: -1: must be a number in count of at least 0");
    EXPECT_EQ(message_on("encoder_zero: { count: 3, std_count: 0, how: [] }\n"),
              ":6: encoder_zero.how: a list: must be text");
    EXPECT_EQ(
        message_on("encoder_zero: { count: 3, std_count: 0, zero: 1 }\n").find(":6: encoder_zero.zero: 1: "),
        0u);
    EXPECT_EQ(message_on("controllers: pd\n"), ":6: controllers: pd: must be a map of keys and values");
    EXPECT_EQ(message_on("controllers: {}\n"),
              ":6: controllers: a map: names no controller; allowed: macro, micro");
    EXPECT_EQ(message_on("controllers: { macro: { e0: 1 } }\n"),
              ":6: controllers.macro.name: missing: this key must be given");
    EXPECT_EQ(message_on("controllers: { macro: { name: a, e0: b } }\n"),
              ":6: controllers.macro.e0: b: must be a number");
    EXPECT_EQ(message_on("controllers: { macro: pi_antiwindup }\n"),
              ":6: controllers.macro: pi_antiwindup: is a controller of the micro stage");
    EXPECT_EQ(message_on("controllers: { micro: nonlinear_pd }\n"),
              ":6: controllers.micro: nonlinear_pd: is a controller of the macro stage");
    EXPECT_EQ(message_on("events: homing\n"), ":6: events: homing: must be a list");
    EXPECT_EQ(message_on("events: [ { time_ns: 1.5, what: a } ]\n"),
              ":6: events[0].time_ns: 1.5: must be a whole number");
    EXPECT_EQ(message_on("events: [ { time_ns: 1 } ]\n"),
              ":6: events[0].what: missing: this key must be given");
    EXPECT_EQ(message_on("events: [ { time_ns: 2, what: a }, { time_ns: 1, what: b } ]\n"),
              ":6: events[1].time_ns: 1: must not be before the event before it, 2 ns");
    EXPECT_EQ(message_on("stage: [sim]\n"), ":6: stage: a list: must be text");
    EXPECT_EQ(message_on("finished: perhaps\n"), ":6: finished: perhaps: must be true or false");
    EXPECT_EQ(message_on("encoderzero: 3\n").find(":6: encoderzero: 3: "), 0u);
}

TEST(RecordingArchive, FiveKeys_AreReadForEver) {
    const Recording read = read_recording(archive / "five-keys");
    EXPECT_EQ(read.name, "macro-square-1");
    EXPECT_EQ(read.rig, "reference-rig");
    EXPECT_EQ(read.experiment, "macro-square");
    EXPECT_DOUBLE_EQ(read.tick_s, 0.001);
    EXPECT_FALSE(read.encoder_zero || read.controllers || read.is_unfinished);
    ASSERT_EQ(read.rows.size(), 3u);
    EXPECT_EQ(read.rows[2].time_ns, 2'000'000);
    EXPECT_DOUBLE_EQ(read.rows[2].macro_setpoint_mm, 135.72);
    EXPECT_DOUBLE_EQ(read.rows[2].macro_command_V, 3.8865884);
    EXPECT_DOUBLE_EQ(read.rows[2].encoder_count, 2001);
    EXPECT_TRUE(std::isnan(read.rows[2].micro_setpoint_mm));
    EXPECT_DOUBLE_EQ(read.rows[2].hall_adc, 1024);
    ASSERT_EQ(read.detections.size(), 1u);
    EXPECT_EQ(read.detections[0].tag_id, 50);
    EXPECT_DOUBLE_EQ(read.detections[0].corners_px[3].y(), 329.4978);
}

TEST(RecordingArchive, WithOrigin_IsReadForEver) {
    const Recording read = read_recording(archive / "with-origin");
    EXPECT_EQ(read.name, "integrated-2");
    ASSERT_TRUE(read.encoder_zero && read.controllers);
    EXPECT_EQ(read.encoder_zero->count, -3210.25);
    EXPECT_EQ(read.encoder_zero->std_count, 0.3);
    EXPECT_EQ(read.encoder_zero->how, "end stop, then tag 5");
    EXPECT_EQ(read.controllers->macro, "nonlinear_pd");
    EXPECT_EQ(read.controllers->micro, "pi_antiwindup");
    EXPECT_FALSE(read.is_unfinished);
    ASSERT_EQ(read.events.size(), 2u);
    EXPECT_EQ(read.events[0].time_ns, 9'000'000'001'000);
    EXPECT_EQ(read.events[0].what, "frames_lost");
    EXPECT_EQ(read.events[0].text, "2");
    ASSERT_EQ(read.rows.size(), 2u);
    EXPECT_DOUBLE_EQ(read.rows[1].micro_command_V, 1.9);
    EXPECT_DOUBLE_EQ(read.rows[0].encoder_count, -1211);
    EXPECT_TRUE(read.detections.empty());
}

TEST(UnfinishedRecording, WriterNotClosed_LeavesAllThatItWasGiven) {
    const TemporaryFolder folder;
    {
        RecordingWriter writer(folder / "a", options_named("a"));
        ASSERT_TRUE(writer.add(StageRow{.encoder_count = 3}));
        writer.add({0, "fault", "gone"});
    }
    const Recording read = read_recording(folder / "a");
    EXPECT_TRUE(read.is_unfinished);
    EXPECT_EQ(read.rows.size(), 1u);
    ASSERT_EQ(read.events.size(), 1u);
    EXPECT_EQ(read.events[0].what, "fault");
}

TEST(UnfinishedRecording, LastLineThatDoesNotEnd_IsLeftOut) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", std::string(five_keys) + "finished: false\n");
    folder.write("stage0/data.csv", "#timestamp [ns],encoder [count]\n0,5\n1000,6\n2000,");
    folder.write("cam0/detections.csv", text_of(archive / "five-keys/cam0/detections.csv") + "1300000,51,48");
    folder.write("cam0/data.csv", "#timestamp [ns],filename\n3300000,a.png\n3300");
    const Recording read = read_recording(folder.path());
    EXPECT_TRUE(read.is_unfinished);
    EXPECT_EQ(read.rows.size(), 2u);
    EXPECT_EQ(read.detections.size(), 1u);
    EXPECT_EQ(read.frames.size(), 1u);
}

TEST(UnfinishedRecording, FilesWithoutAWholeLine_CountAsNotThere) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", std::string(five_keys) + "finished: false\n");
    folder.write("stage0/data.csv", "#timestamp [ns],enc");
    folder.write("cam0/detections.csv", "");
    const Recording read = read_recording(folder.path());
    EXPECT_TRUE(read.rows.empty() && read.detections.empty());
    EXPECT_FALSE(read.columns.encoder);
}

TEST(UnfinishedRecording, FinishedOne_CutOffIsRefusedAsEver) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", std::string(five_keys) + "finished: true\n");
    const auto file = folder.write("stage0/data.csv", "#timestamp [ns],encoder [count]\n0,5\n1000,");
    EXPECT_EQ(message_of([&] { read_recording(folder.path()); }),
              file.string() + ":3: the last line does not end: the file was cut off");
}

TEST(UnfinishedRecording, OtherMistakes_AreStillRefused) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", std::string(five_keys) + "finished: false\n");
    folder.write("stage0/data.csv", "#timestamp [ns],encoder [count]\n0,x\n1000,");
    EXPECT_THROW(read_recording(folder.path()), InputError);
}

}  // namespace
}  // namespace fidservo
