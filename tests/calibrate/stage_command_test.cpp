// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo calibrate stage on the real executable.
#include "core/camera/camera_covariance.h"
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "tests/effort.h"
#include "tests/src/run_program.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::run_program;
using testing::TemporaryFolder;
using testing::text_of;

void expect_refusal(const std::vector<std::string>& arguments, const TemporaryFolder& folder,
                    const std::vector<std::string>& pieces) {
    std::vector<std::string> all{"calibrate", "stage"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const testing::ProgramRun run = run_program(all, folder.path());
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const std::string& piece : pieces)
        EXPECT_NE(run.err.find(piece), std::string::npos) << piece << "\n" << run.err;
}

/// The reference rig's file with a change, beside its table of curves.
std::filesystem::path rig_with(const TemporaryFolder& folder, const std::string& from,
                               const std::string& to) {
    std::filesystem::copy_file(FIDSERVO_ASSETS_DIR "/preisach_fod.csv", folder / "preisach_fod.csv",
                               std::filesystem::copy_options::skip_existing);
    std::string text = text_of(FIDSERVO_ASSETS_DIR "/rig.yaml");
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    return folder.write("rig.yaml", text.replace(at, from.size(), to));
}

std::filesystem::path rig_with_effect(const TemporaryFolder& folder, const std::string& effect) {
    return rig_with(folder, "fiducials:", "effects: [" + effect + "]\nfiducials:");
}

TEST(CalibrateStageCommand, WhatIsWrong_IsSaidInALineAndNothingIsMade) {
    const TemporaryFolder folder;
    expect_refusal({}, folder, {"--out", "missing"});
    expect_refusal({"--out", "o", "--write-rig", "./o"}, folder, {"--out, --write-rig", "one name"});
    expect_refusal({"--check", "--write-rig", "new.yaml"}, folder, {"--check, --write-rig"});
    expect_refusal({"--out", "o", "--stage", "comedi:/dev/comedi0"}, folder,
                   {"--camera sim", "allowed beside it: v4l2"});
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
    std::filesystem::create_directory(folder / "there");
    expect_refusal({"--out", "there"}, folder, {"there", "exists already"});
    folder.write("old.yaml", "");
    expect_refusal({"--out", "o", "--write-rig", "old.yaml"}, folder, {"old.yaml", "exists already"});
    expect_refusal({"--out", "o", "--write-rig", "old.yaml/new.yaml"}, folder,
                   {"--write-rig: old.yaml/new.yaml: cannot be made in old.yaml: no folder"});
    const auto effect = rig_with_effect(folder, "{ name: pixel_scale, factor: 1.001 }").string();
    expect_refusal({"--rig", effect, "--out", "o", "--write-rig", "new.yaml"}, folder,
                   {"pixel_scale", "twice", "--sim-rig"});
    const auto no_camera = folder.write("bare.yaml", text_of(FIDSERVO_DATA_DIR "/emps/rig.yaml"));
    if (!text_of(no_camera).empty())
        expect_refusal({"--rig", no_camera.string(), "--out", "o"}, folder, {"missing"});
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST(SlowCalibrateStageCommand, CalibratedRigFile_IsHealthyAndItsDriftIsFound) {
    const TemporaryFolder folder;
    const auto truth =
        rig_with_effect(folder,
                        "{ name: pixel_scale, factor: 1.003 }, { name: camera_rotation, angle_deg: 0.5 }")
            .string();
    const auto calibrated = run_program(
        {"calibrate", "stage", "--sim-rig", truth, "--out", "calibrated", "--write-rig", "calibrated.yaml"},
        folder.path());
    EXPECT_EQ(calibrated.exit_code, 0) << calibrated.out << calibrated.err;
    for (const char* file : {"calibrated/report.html", "calibrated/stage.json", "calibrated/stands.csv",
                             "calibrated/recording/stage0/data.csv", "calibrated.yaml"})
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
    const CameraParameters camera = load_rig(folder / "calibrated.yaml").camera.value();
    const double scale_std =
        std::sqrt(camera.geometry_covariance(camera_distance, camera_distance)) / camera.geometry.distance_mm;
    EXPECT_GT(scale_std, 1e-8);
    EXPECT_LT(scale_std, 1e-4);
    // A rig that is as its file says is looked at without the program, too (stage_calibration_test.cpp).
    if (testing::has_all_draws()) {
        const auto healthy = run_program(
            {"calibrate", "stage", "--check", "--rig", "calibrated.yaml", "--sim-rig", truth, "--seed", "5"},
            folder.path());
        EXPECT_EQ(healthy.exit_code, 0) << healthy.out << healthy.err;
    }
    const auto drifted =
        run_program({"calibrate", "stage", "--check", "--sim-rig", truth, "--out", "check"}, folder.path());
    EXPECT_EQ(drifted.exit_code, 1) << drifted.out << drifted.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "check/check.json"));
}

/// The signal comes a second after the tuning, with which homing ends: the survey takes several.
TEST(SlowCalibrateStageCommand, Interrupted_LeavesARecordingThatSaysSo) {
    const TemporaryFolder folder;
    const std::string script = "cd '" + folder.path().string() + "'; '" + std::string(FIDSERVO_PROGRAM) +
                               "' calibrate stage --out o > out 2> err & child=$!; "
                               "until grep -q tuned: err || ! kill -0 $child; do sleep 0.02; done; "
                               "sleep 1; kill -INT $child; wait $child";
    EXPECT_NE(std::system(script.c_str()), 0);
    EXPECT_NE(text_of(folder / "err").find("calibrate stage: stopped: stopped by the user"),
              std::string::npos)
        << text_of(folder / "err");
    const std::string recording = text_of(folder / "o/recording/recording.yaml");
    EXPECT_NE(recording.find("finished: false"), std::string::npos) << recording;
    EXPECT_NE(recording.find("how: \"end stop, then tag"), std::string::npos) << recording;
}

}  // namespace
}  // namespace fidservo
