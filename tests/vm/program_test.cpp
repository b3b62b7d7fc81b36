// The program itself on a camera that crosses the kernel.
#include "core/camera_geometry.h"
#include "src/recording/reader.h"
#include "tests/src/run_program.h"
#include "tests/vm/loopback_feed.h"
#include "tests/vm/plate_on_loopback.h"
#include "vision/tag_refinement.h"

#include <atomic>
#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo::devices {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using vision::v4l2::PixelFormat;

constexpr double place_mm = 100.1234;

/// The reference rig's file with the camera of this test.
fs::path write_rig(const fs::path& folder) {
    fs::copy(fs::path(FIDSERVO_ASSETS_DIR) / "preisach_fod.csv", folder / "preisach_fod.csv");
    std::ifstream in(fs::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    std::ofstream out(folder / "rig.yaml");
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("  width_px:")) line = "  width_px: 640";
        if (line.starts_with("  height_px:")) line = "  height_px: 480\n  capture: { format: GREY }";
        if (line.starts_with("  principal_point_px:")) line = "  principal_point_px: [319.5, 239.5]";
        if (line.starts_with("  frame_rate_hz:")) line = "  frame_rate_hz: 10";
        out << line << '\n';
    }
    return folder / "rig.yaml";
}

/// Shows a frame ten times a second until it ends.
class Feeding {
  public:
    explicit Feeding(const cv::Mat& frame)
        : feed_(loopback_node, PixelFormat::grey, frame.size()),
          thread_([this, frame](const std::stop_token& stop) {
              while (!stop.stop_requested()) {
                  feed_.show(frame);
                  std::this_thread::sleep_for(std::chrono::milliseconds(100));
              }
          }) {}

  private:
    LoopbackFeed feed_;
    std::jthread thread_;
};

TEST(Program, Record_FindsTheTagInEveryFrameThatItKeeps) {
    const testing::TemporaryFolder folder;
    const fs::path rig = write_rig(folder / ".");
    const cv::Mat frame = frames_at({place_mm}).front();
    const Feeding feeding(frame);
    const auto run = testing::run_program(
        {"record", "--rig", rig.string(), "--camera", std::string("v4l2:") + loopback_node, "--duration", "3",
         "--frames", "--out", "rec"},
        folder / ".");
    std::cout << run.out << run.err;
    ASSERT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, HasSubstr(" frames used"));
    const Recording recording = read_recording(folder / "rec");
    ASSERT_GE(recording.frames.size(), 5U);
    EXPECT_EQ(recording.detections.size(), recording.frames.size()) << "one tag is wholly in view";
    const Eigen::Vector2d expected_px = project(loopback_camera().geometry, {100.0, 0.0}, place_mm);
    for (const TagDetection& tag : recording.detections) {
        EXPECT_EQ(tag.tag_id, 50);
        EXPECT_LT((vision::centre_px(tag) - expected_px).norm(), 0.1);
    }
    for (const FrameName& name : recording.frames) {
        const cv::Mat kept = cv::imread(folder / "rec/cam0/data" / name.filename, cv::IMREAD_GRAYSCALE);
        EXPECT_EQ(cv::norm(kept, frame, cv::NORM_INF), 0.0) << name.filename;
    }
}

TEST(Program, CameraOfAnotherSize_IsWrongInputThatNamesTheKey) {
    const testing::TemporaryFolder folder;
    const Feeding feeding(frames_at({place_mm}).front());
    const auto run = testing::run_program({"record", "--rig", FIDSERVO_ASSETS_DIR "/rig.yaml", "--camera",
                                           std::string("v4l2:") + loopback_node, "--out", "rec"},
                                          folder / ".");
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("camera.width_px, height_px: 1280 x 960"));
    EXPECT_THAT(run.err, HasSubstr("640x480"));
}

}  // namespace
}  // namespace fidservo::devices
