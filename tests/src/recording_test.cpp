// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/recording/reader.h"
#include "src/files/recording/writer.h"
#include "src/files/rig/rig_file.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo {
namespace {

using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

constexpr const char* description =
    "format: fidservo-recording/1\nname: a\nrig: reference-rig\ntick_s: 0.001\nexperiment: rest\n";

const std::string stage_titles = "#timestamp [ns],macro_setpoint [mm],macro_command [V],encoder [count]\n";

/// A recording folder whose stage0/data.csv is `stage`; the reader's message without the file's path.
std::string stage_message(const std::string& stage) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", description);
    const auto file = folder.write("stage0/data.csv", stage);
    return message_of([&] { read_recording(folder.path()); }).substr(file.string().size());
}

Recording example() {
    Recording recording;
    recording.name = "a";
    recording.rig = "reference-rig";
    recording.experiment = "rest";
    recording.tick_s = 0.001;
    recording.columns = columns_of(load_rig(reference_rig_file()));
    for (int k = 0; k < 20'000; ++k)
        recording.rows.push_back({.time_ns = k * ns_per_ms,
                                  .macro_setpoint_mm = k < 10'000 ? not_in_force : 12.3456,
                                  .macro_command_V = k == 3 ? -1e-9 : -3.3364688,
                                  .encoder_count = -7.0 + k,
                                  .micro_setpoint_mm = 2.2946699,
                                  .micro_command_V = 1.9,
                                  .hall_adc = 1024});
    for (int k = 0; k < 500; ++k) {
        TagDetection detection;
        detection.time_ns = 3'300'000 + k * 20 * ns_per_ms;
        detection.tag_id = k % 101;
        for (std::size_t corner = 0; corner < 4; ++corner)
            detection.corners_px[corner] = {502.0403 + k, 629.5229};
        recording.detections.push_back(detection);
    }
    return recording;
}

TEST(Recording, WrittenAndRead_IsTheSame) {
    const TemporaryFolder folder;
    const Recording written = example();
    write_recording(folder / "a", written, load_rig(reference_rig_file()).camera);
    const Recording read = read_recording(folder / "a");
    EXPECT_EQ(read.name, written.name);
    EXPECT_EQ(read.rig, written.rig);
    EXPECT_EQ(read.experiment, written.experiment);
    EXPECT_DOUBLE_EQ(read.tick_s, written.tick_s);
    ASSERT_EQ(read.rows.size(), written.rows.size());
    EXPECT_TRUE(std::isnan(read.rows[0].macro_setpoint_mm));
    for (std::size_t k = 0; k < read.rows.size(); ++k) {
        ASSERT_EQ(read.rows[k].time_ns, written.rows[k].time_ns);
        ASSERT_EQ(read.rows[k].encoder_count, written.rows[k].encoder_count);
        ASSERT_NEAR(read.rows[k].macro_command_V, written.rows[k].macro_command_V, 0.5e-7);
    }
    EXPECT_DOUBLE_EQ(read.rows[10'000].macro_setpoint_mm, 12.3456);
    ASSERT_EQ(read.detections.size(), written.detections.size());
    EXPECT_EQ(read.detections[7].tag_id, 7);
    EXPECT_NEAR(read.detections[7].corners_px[2].x(), 509.0403, 1e-9);
}

TEST(Recording, SameInput_GivesTheSameBytes) {
    const TemporaryFolder folder;
    for (const char* name : {"a", "b"})
        write_recording(folder / name, example(), load_rig(reference_rig_file()).camera);
    for (const char* file :
         {"recording.yaml", "stage0/data.csv", "cam0/sensor.yaml", "cam0/detections.csv"}) {
        EXPECT_EQ(text_of(folder / "a" / file), text_of(folder / "b" / file)) << file;
        EXPECT_FALSE(text_of(folder / "a" / file).empty()) << file;
    }
}

TEST(Recording, Rows_AreWrittenAsTheSharedCampaignsAre) {
    const TemporaryFolder folder;
    write_recording(folder / "a", example(), std::nullopt);
    EXPECT_TRUE(text_of(folder / "a" / "stage0/data.csv")
                    .starts_with("#timestamp [ns],macro_setpoint [mm],macro_command [V],encoder [count],"
                                 "micro_setpoint [mm],micro_command [V],hall [adc]\n"
                                 "0,,-3.3364688,-7,2.2946699,1.9000000,1024\n"));
    EXPECT_EQ(text_of(folder / "a" / "stage0/data.csv").find("-0.0000000"), std::string::npos);
}

TEST(Recording, PlateThatItWasMadeOver_IsReadBack) {
    const TemporaryFolder folder;
    Recording written = example();
    written.plate = {{.id = 40, .centre_mm = {7.05, -0.1}, .side_mm = 1.2, .angle_rad = 0.25},
                     {.id = 3, .centre_mm = {1.0 / 3.0, 0.0}, .side_mm = 0.8}};
    write_recording(folder / "a", written, std::nullopt);
    const std::vector<PlateTag> read = read_recording(folder / "a").plate;
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].id, 40);
    EXPECT_EQ(read[0].centre_mm, written.plate[0].centre_mm);
    EXPECT_NEAR(read[0].angle_rad, 0.25, 1e-15);
    EXPECT_EQ(read[1], written.plate[1]);
    write_recording(folder / "b", example(), std::nullopt);
    EXPECT_FALSE(std::filesystem::exists(folder / "b/plate.yaml"));
    EXPECT_TRUE(read_recording(folder / "b").plate.empty());
}

/// The step that is read from a file whose setpoints are these; the default where they do not tell.
double setpoint_step_mm(const std::vector<std::string>& setpoints) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", description);
    std::string stage = stage_titles;
    for (std::size_t k = 0; k < setpoints.size(); ++k) stage += fmt::format("{},{},1,5\n", k, setpoints[k]);
    folder.write("stage0/data.csv", stage);
    return read_recording(folder.path()).macro_setpoint_step_mm;
}

TEST(Recording, StepOfASetpoint_IsThatOfItsLastDigit) {
    const double usual_mm = Recording().macro_setpoint_step_mm;
    EXPECT_DOUBLE_EQ(setpoint_step_mm({"102.28", "", "50.00"}), 1e-2);
    EXPECT_DOUBLE_EQ(setpoint_step_mm({"102.275", "0.000"}), 1e-3);
    EXPECT_DOUBLE_EQ(setpoint_step_mm({"102.27500", "-1.25000"}), 1e-5);
    EXPECT_DOUBLE_EQ(setpoint_step_mm({"1.02275e+02", "1.50000e+02"}), 1e-3);
    EXPECT_EQ(setpoint_step_mm({"102.275", "102.3"}), usual_mm) << "zeros are left away";
    EXPECT_EQ(setpoint_step_mm({"100", "50"}), usual_mm) << "whole numbers";
    EXPECT_EQ(setpoint_step_mm({"", ""}), usual_mm);
}

TEST(Recording, SharedCampaigns_ReadAndWriteByteForByte) {
    const auto campaign = std::filesystem::path(FIDSERVO_DATA_DIR) / "campaigns" / "no-effect";
    if (!std::filesystem::exists(campaign)) GTEST_SKIP() << "no shared data at " << campaign;
    const auto recordings = find_recordings(campaign);
    EXPECT_EQ(recordings.size(), 16u);
    const TemporaryFolder folder;
    const auto camera = load_rig(reference_rig_file()).camera;
    for (const auto& original : recordings) {
        const auto copy = folder / original.filename();
        write_recording(copy, read_recording(original), camera);
        for (const char* file : {"stage0/data.csv", "cam0/detections.csv"})
            EXPECT_TRUE(text_of(copy / file) == text_of(original / file)) << original / file;
        EXPECT_EQ(text_of(copy / "recording.yaml"),
                  text_of(original / "recording.yaml") + "finished: true\n");
    }
}

TEST(Recording, RigWithPositionInPlaceOfAnEncoder_IsRead) {
    const auto folder = std::filesystem::path(FIDSERVO_DATA_DIR) / "emps" / "emps-pulses";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data at " << folder;
    const Recording recording = read_recording(folder);
    EXPECT_TRUE(recording.columns.position && recording.columns.macro_command);
    EXPECT_FALSE(recording.columns.encoder || recording.columns.hall);
    EXPECT_GT(recording.rows.size(), 20'000u);
    EXPECT_TRUE(std::isfinite(recording.rows[5].position_mm) && std::isnan(recording.rows[5].encoder_count));
}

TEST(Recording, ColumnsInAnyOrder_AreKnownByTitle) {
    const TemporaryFolder folder;
    folder.write("recording.yaml", description);
    folder.write("stage0/data.csv", "encoder [count],timestamp [ns],hall [adc]\n5,10,7\n6,20,\n");
    const Recording recording = read_recording(folder.path());
    EXPECT_EQ(recording.rows[1].time_ns, 20);
    EXPECT_EQ(recording.rows[1].encoder_count, 6.0);
    EXPECT_EQ(recording.rows[0].hall_adc, 7.0);
    EXPECT_TRUE(std::isnan(recording.rows[1].hall_adc));
    EXPECT_FALSE(recording.columns.macro_command);
}

TEST(Recording, MistakesInTheStageFile_AreNamedWithTheirLine) {
    EXPECT_EQ(stage_message(stage_titles + "0,,1,5\n1000,,1"),
              ":3: the last line does not end: the file was cut off");
    EXPECT_EQ(stage_message(stage_titles + "0,,1,5\n1000,,1\n"), ":3: has 3 fields; the header names 4");
    EXPECT_EQ(stage_message(stage_titles + "0,,nan,5\n"), ":2: column 3: 'nan': must be finite");
    EXPECT_EQ(stage_message(stage_titles + "0,,1 V,5\n"), ":2: column 3: '1 V': must be a number");
    EXPECT_EQ(stage_message(stage_titles + "0.5,,1,5\n"), ":2: column 1: '0.5': must be a whole number");
    EXPECT_EQ(stage_message(stage_titles + "2000,,1,5\n1000,,1,5\n"),
              ":3: timestamp: 1000: must be after the one before, 2000 ns");
    EXPECT_EQ(stage_message("#timestamp [ns],encoder [mm]\n"),
              ":1: column 'encoder [mm]': unknown unit; it must be 'encoder [count]'");
    EXPECT_EQ(stage_message("#timestamp [ns],encodr [count]\n"),
              ":1: column 'encodr [count]': unknown; did you mean 'encoder [count]'?");
    EXPECT_EQ(stage_message("encoder [count]\n5\n"), ":1: column 'timestamp [ns]' is missing");
    EXPECT_EQ(
        stage_message("#timestamp [ns],macro_command [V]\n0,1\n"),
        ":1: column 'encoder [count]', 'position [mm]' or 'hall [adc]' is missing: nothing was measured");
    EXPECT_EQ(stage_message(""), ": is empty");
}

TEST(Recording, FolderOfRecordings_StandsForThem) {
    const TemporaryFolder folder;
    folder.write("b/recording.yaml", description);
    folder.write("a/recording.yaml", description);
    folder.write("notes/text.txt", "");
    const std::vector<std::filesystem::path> expected{folder / "a", folder / "b"};
    EXPECT_EQ(find_recordings(folder.path()), expected);
    EXPECT_EQ(find_recordings(folder / "a"), std::vector<std::filesystem::path>{folder / "a"});
    EXPECT_THROW(find_recordings(folder / "notes"), InputError);
    EXPECT_THROW(find_recordings(folder / "none"), InputError);
}

TEST(RecordingWriter, ExistingFolder_IsNotTouched) {
    const TemporaryFolder folder;
    folder.write("a/precious.txt", "keep");
    EXPECT_THROW(write_recording(folder / "a", example(), std::nullopt), InputError);
    EXPECT_EQ(text_of(folder / "a/precious.txt"), "keep");
    EXPECT_FALSE(std::filesystem::exists(folder / "a/recording.yaml"));
}

TEST(RecordingWriter, Frames_AreKeptAsTheyWere) {
    const TemporaryFolder folder;
    const cv::Mat image = (cv::Mat_<unsigned char>(2, 3) << 1, 2, 3, 250, 251, 252);
    RecordingWriter writer(folder / "a", {.name = "a",
                                          .rig = "r",
                                          .experiment = "rest",
                                          .columns = {.encoder = true},
                                          .camera = load_rig(reference_rig_file()).camera,
                                          .frames = true});
    ASSERT_TRUE(writer.add(StageRow{.encoder_count = 3}));
    ASSERT_TRUE(writer.add_frame(3'300'000, image));
    ASSERT_TRUE(writer.close());
    const Recording recording = read_recording(folder / "a");
    ASSERT_EQ(recording.frames.size(), 1u);
    EXPECT_EQ(recording.frames[0].time_ns, 3'300'000);
    const cv::Mat read =
        cv::imread((folder / "a/cam0/data" / recording.frames[0].filename).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(read.size(), image.size());
    EXPECT_EQ(cv::norm(read, image), 0.0);
}

}  // namespace
}  // namespace fidservo
