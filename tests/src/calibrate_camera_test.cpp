// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/calibrate_camera.h"

#include "core/rig.h"
#include "src/calibrate/camera_images.h"
#include "src/files/rig/rig_file.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;

TEST(CameraTarget, KalibrsFile_IsItsGridInMillimetres) {
    const TemporaryFolder folder;
    const CameraTarget target = load_kalibr_target(folder.write(
        "april.yaml", "target_type: 'aprilgrid'\ntagCols: 6\ntagRows: 5\ntagSize: 0.088\ntagSpacing: 0.3\n"));
    ASSERT_EQ(target.tags.size(), 30U);
    EXPECT_EQ(target.print().border_cells, 2);
    EXPECT_EQ(target.tags[7].id, 7);
    EXPECT_DOUBLE_EQ(target.tags[7].side_mm, 88.0);
    EXPECT_NEAR(target.tags[7].centre_mm.x(), 114.4, 1e-9);
    EXPECT_NEAR(target.tags[7].centre_mm.y(), -114.4, 1e-9);  // the second row is above the first
}

TEST(CameraTarget, MistakesInIt_AreNamed) {
    EXPECT_THAT(message_of([] { april_grid("6by6", 88.0, 0.3); }), HasSubstr("--grid: 6by6"));
    EXPECT_THAT(message_of([] { april_grid("0x6", 88.0, 0.3); }), HasSubstr("--grid: 0x6"));
    EXPECT_THAT(message_of([] { april_grid("30x30", 88.0, 0.3); }), HasSubstr("587"));
    EXPECT_THAT(message_of([] { april_grid("6x6", 0.0, 0.3); }), HasSubstr("--tag-size-mm"));
    EXPECT_THAT(message_of([] { april_grid("6x6", 88.0, 0.0); }), HasSubstr("--tag-spacing"));
    const TemporaryFolder folder;
    const auto board = folder.write("board.yaml", "target_type: 'checkerboard'\ntargetCols: 6\n");
    EXPECT_THAT(message_of([&] { load_kalibr_target(board); }), HasSubstr("board.yaml"));
}

TEST(CalibrateCamera, ImagesThatHoldNoTarget_AreWrongInput) {
    const TemporaryFolder folder;
    const CameraTarget grid = april_grid(6, 6, 88.0, 0.3);
    EXPECT_THAT(message_of([&] { read_calibration_images({folder.path()}, grid); }),
                HasSubstr("holds no image"));
    cv::imwrite((folder / "a.png").string(), cv::Mat(240, 320, CV_16UC3, cv::Scalar::all(20000)));
    EXPECT_THAT(message_of([&] { read_calibration_images({folder.path()}, grid); }),
                HasSubstr("no tag of the target"));
    cv::imwrite((folder / "b.png").string(), cv::Mat(200, 320, CV_8UC1, cv::Scalar(80)));
    EXPECT_THAT(message_of([&] { read_calibration_images({folder.path()}, grid); }), HasSubstr("200 px"));
}

TEST(CalibrateCamera, FilesThatExistOrAreOne_AreRefusedFirst) {
    const TemporaryFolder folder;
    CalibrateCameraOptions options;
    options.inputs = {folder / "nothing"};
    options.rig_file = reference_rig_file();
    options.write_rig = folder.write("rig.yaml", "");
    EXPECT_THAT(message_of([&] { calibrate_camera(options); }), HasSubstr("--write-rig"));
    options.write_rig = options.camera_info = folder / "new.yaml";
    EXPECT_THAT(message_of([&] { calibrate_camera(options); }), HasSubstr("are one file"));
    options.write_rig.clear();
    EXPECT_THAT(message_of([&] { calibrate_camera(options); }), HasSubstr("there is no such file or folder"));
    options.lens = "fish";
    EXPECT_EQ(message_of([&] { calibrate_camera(options); }),
              "--lens: fish: allowed: plumb_bob, equidistant");
}

}  // namespace
}  // namespace fidservo
