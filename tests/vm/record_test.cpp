// SPDX-License-Identifier: GPL-3.0-or-later
// `fidservo record` and `fidservo cameras` on a camera behind the kernel (v4l2loopback): what the recording
// holds is what was shown.
#include "core/rig.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "tests/src/run_program.h"
#include "tests/vm/loopback_feed.h"
#include "tests/vm/plate_on_loopback.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo::devices {
namespace {

using ::testing::HasSubstr;

constexpr const char* rig_file = FIDSERVO_SOURCE_DIR "/tests/vm/inspection/rig.yaml";
constexpr int places = 40;

double place_mm(std::size_t k) {
    return 99.1 + 0.041 * static_cast<double>(k % places);
}

/// The plate as that rig's camera sees it, shown one place after the other until this object goes.
class ShownPlate {
  public:
    explicit ShownPlate(const Rig& rig)
        : feed_(loopback_node, vision::v4l2::PixelFormat::grey,
                {rig.camera->geometry.width_px, rig.camera->geometry.height_px}),
          period_(2.0 / rig.camera->frame_rate_hz) {
        const plant::PlateView view(*rig.camera, plate_of(*rig.fiducials), {});
        for (std::size_t k = 0; k < places; ++k)
            frames_.push_back(view.render(std::vector<double>{place_mm(k)}, k));
        thread_ = std::jthread([this](const std::stop_token& stop) {
            for (std::size_t k = 0; !stop.stop_requested(); ++k) {
                feed_.show(frames_[k % places]);
                std::this_thread::sleep_for(period_);
            }
        });
    }
    const std::vector<cv::Mat>& frames() const { return frames_; }

  private:
    LoopbackFeed feed_;
    std::chrono::duration<double> period_;
    std::vector<cv::Mat> frames_;
    std::jthread thread_;
};

/// How far the corners are from where they were rendered. Zero for a tag at the image's edge: the detector
/// puts corners a few pixels off there, and the camera's place is taken from another tag.
double farthest_px(const CameraGeometry& camera, const TagDetection& tag, double s_mm) {
    constexpr double edge_px = 5.0;
    double farthest = 0.0;
    for (std::size_t k = 0; k < tag_corners.size(); ++k) {
        const Eigen::Vector2d corner_mm = Eigen::Vector2d(2.0 * tag.tag_id, 0.0) + 0.6 * tag_corners[k];
        const Eigen::Vector2d rendered_px = project(camera, corner_mm, s_mm);
        if (rendered_px.x() < edge_px || rendered_px.x() > camera.width_px - 1 - edge_px) return 0.0;
        farthest = std::max(farthest, (tag.corners_px[k] - rendered_px).norm());
    }
    return farthest;
}

testing::ProgramRun record(const std::filesystem::path& out) {
    return testing::run_program(
        {"record", "--rig", rig_file, "--camera", std::string("v4l2:") + loopback_node, "--frames",
         "--duration", "10", "--out", out.string()},
        out.parent_path());
}

TEST(Record, FramesAndFiducials_AreThoseThatWereShown) {
    const Rig rig = load_rig(rig_file);
    const ShownPlate plate(rig);
    const testing::TemporaryFolder folder;
    const testing::ProgramRun run = record(folder / "seen");
    std::cout << run.out << run.err;
    ASSERT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, HasSubstr("frames used"));
    const Recording recording = read_recording(folder / "seen");
    EXPECT_GE(recording.rows.size(), 1000U) << "the simulated stage beside it";
    EXPECT_GE(recording.frames.size(), 10U);
    std::set<TimeNs> with_tag;
    double largest_px = 0.0;
    for (const FrameName& frame : recording.frames) {
        const cv::Mat image =
            cv::imread((folder / "seen/cam0/data" / frame.filename).string(), cv::IMREAD_GRAYSCALE);
        const auto shown = std::ranges::find_if(
            plate.frames(), [&](const cv::Mat& one) { return cv::norm(image, one, cv::NORM_INF) == 0.0; });
        ASSERT_NE(shown, plate.frames().end()) << frame.filename << " was never shown";
        const double s_mm = place_mm(static_cast<std::size_t>(shown - plate.frames().begin()));
        for (const TagDetection& tag : recording.detections) {
            if (tag.time_ns != frame.time_ns) continue;
            with_tag.insert(tag.time_ns);
            largest_px = std::max(largest_px, farthest_px(rig.camera->geometry, tag, s_mm));
        }
    }
    std::cout << recording.frames.size() << " frames, tags in " << with_tag.size() << ", corners at most "
              << largest_px << " px off\n";
    EXPECT_EQ(with_tag.size(), recording.frames.size());
    EXPECT_LT(largest_px, 0.5);
}

TEST(Record, NoMoreFrames_EndsWithTheReason) {
    const LoopbackFeed feed(loopback_node, vision::v4l2::PixelFormat::grey, {320, 240});
    const testing::TemporaryFolder folder;
    const testing::ProgramRun run = record(folder / "seen");
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.err,
                ::testing::AnyOf(HasSubstr("no whole frame"), HasSubstr("no frame from the camera")));
}

TEST(Cameras, Loopback_IsListedWithWhatItIsFed) {
    const LoopbackFeed feed(loopback_node, vision::v4l2::PixelFormat::grey, {320, 240});
    const testing::TemporaryFolder folder;
    const testing::ProgramRun run = testing::run_program({"cameras"}, folder.path());
    EXPECT_EQ(run.exit_code, 0);
    std::cout << run.out;
    EXPECT_THAT(run.out, HasSubstr(std::string("v4l2:") + loopback_node));
    EXPECT_THAT(run.out, HasSubstr("v4l2 loopback"));
    EXPECT_THAT(run.out, HasSubstr("GREY   320x240"));
}

}  // namespace
}  // namespace fidservo::devices
