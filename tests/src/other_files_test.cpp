// SPDX-License-Identifier: GPL-3.0-or-later
// Folders, camera files and targets of other programs given to the program itself.
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::run_program;
using testing::TemporaryFolder;
using testing::text_of;

void write_image(const std::filesystem::path& file) {
    std::filesystem::create_directories(file.parent_path());
    cv::imwrite(file.string(), cv::Mat(480, 640, CV_8UC1, cv::Scalar(128)));
}

TEST(OtherFiles, EuRoCFolderWithAMarkOrWithoutTitles_IsReplayed) {
    const TemporaryFolder folder;
    const std::string rows =
        "1403636579763555584,1403636579763555584.png\n1403636579813555584,1403636579813555584.png";
    for (const char* image : {"1403636579763555584.png", "1403636579813555584.png"})
        write_image(folder / "mav0/cam0/data" / image);
    int run_number = 0;
    for (const std::string& text : {"\xEF\xBB\xBF#timestamp [ns],filename\n" + rows + "\n", rows + "\n",
                                    "#timestamp [ns],filename\n" + rows}) {
        folder.write("mav0/cam0/data.csv", text);
        const std::string out = fmt::format("out{}", run_number++);
        const auto run = run_program({"replay", "mav0", "--out", out}, folder.path());
        EXPECT_LT(run.exit_code, 2) << run.err;
        EXPECT_THAT(run.out, HasSubstr("2 images"));
        EXPECT_THAT(text_of(folder / out / "detections.csv"), ::testing::StartsWith("#timestamp [ns]"));
    }
}

TEST(OtherFiles, RosFileOfAnIdealCamera_GivesARigItsCamera) {
    const TemporaryFolder folder;
    write_image(folder / "image.png");
    const std::filesystem::path assets = FIDSERVO_ASSETS_DIR;
    std::filesystem::copy_file(assets / "preisach_fod.csv", folder / "preisach_fod.csv");
    std::string rig = text_of(assets / "rig.yaml");
    const std::string own =
        "  width_px: 1280\n  height_px: 960\n  focal_px: 5000\n  principal_point_px: [639.5, 479.5]\n";
    folder.write("rig.yaml", rig.replace(rig.find(own), own.size(), "  camera_info: camera.yaml\n"));
    folder.write("camera.yaml",
                 "image_width: 640\nimage_height: 480\ncamera_name: c\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
                 "  data: [430.25, 0., 311.5, 0., 430.5, 221., 0., 0., 1.]\ndistortion_model: \"\"\n"
                 "distortion_coefficients:\n  rows: 0\n  cols: 0\n  data: []\n");
    const auto run = run_program({"replay", "image.png", "--rig", "rig.yaml", "--out", "out"}, folder.path());
    EXPECT_LT(run.exit_code, 2) << run.err;
}

TEST(OtherFiles, ChessboardAsATarget_IsNamedAsThat) {
    const TemporaryFolder folder;
    write_image(folder / "grid.png");
    folder.write("checker.yaml",
                 "target_type: 'checkerboard'\ntargetCols: 6\ntargetRows: 7\nrowSpacingMeters: 0.06\n");
    const auto run =
        run_program({"calibrate", "camera", "grid.png", "--target", "checker.yaml"}, folder.path());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.err, "fidservo: checker.yaml:1: target_type: checkerboard: allowed: aprilgrid\n");
}

}  // namespace
}  // namespace fidservo
