// SPDX-License-Identifier: GPL-3.0-or-later
// The V4L2 camera on the kernel's own test driver, which can also misbehave when told to.
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "tests/next_frame.h"
#include "vision/v4l2/camera_list.h"
#include "vision/v4l2/v4l2_camera.h"

#include <cmath>
#include <iostream>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <opencv2/core.hpp>

namespace fidservo::vision::v4l2 {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr const char* node = "/dev/video10";
constexpr int black = 5, white = 6;  // of "Test Pattern"
constexpr int no_text = 2;           // of "OSD Text Mode"
constexpr int webcam_input = 0, hdmi_input = 3;

CaptureSettings settings() {
    CaptureSettings settings;
    settings.width_px = 320;
    settings.height_px = 180;
    settings.frame_rate_hz = 25.0;
    settings.exposure_s = 0.002;
    settings.latency_s = 0.030;
    settings.pixels = PixelFormat::grey;
    return settings;
}

class Vivid : public ::testing::Test {
  protected:
    void SetUp() override {
        choose_input(webcam_input);
        for (const auto& [name, value] :
             {std::pair("OSD Text Mode", no_text), std::pair("Test Pattern", white),
              std::pair("Percentage of Dropped Buffers", 0), std::pair("Wrap Timestamp", 0),
              std::pair("Timestamp Source", 0)})
            set(name, value);
    }

    static void set(const std::string& name, std::int64_t value) {
        const auto device = Device::open(node);
        ASSERT_TRUE(device) << device.error().text;
        for (const Control& control : list_controls(*device))
            if (control.name == name) {
                ASSERT_EQ(set_control(*device, control.id, value), 0) << name;
                return;
            }
        FAIL() << "vivid has no control " << name;
    }
    static void press(const std::string& button) { set(button, 1); }

    static void choose_input(int input) {
        const auto device = Device::open(node);
        ASSERT_TRUE(device) << device.error().text;
        ASSERT_EQ(device->request(VIDIOC_S_INPUT, &input), 0);
    }

    static std::string fault_of(const CaptureSettings& settings) {
        try {
            const V4l2Camera camera(node, settings);
        } catch (const RunFault& fault) {
            return fault.what();
        }
        return "";
    }

    static double mean_of(V4l2Camera& camera) { return cv::mean(next_frame(camera).image)[0]; }
};

TEST_F(Vivid, IsListedWithWhatItHas) {
    for (const ListedCamera& camera : list_cameras()) {
        if (camera.node != node) continue;
        EXPECT_EQ(camera.driver, "vivid");
        std::set<std::uint32_t> formats;
        for (const OfferedFormat& format : camera.formats) formats.insert(format.fourcc);
        for (const PixelFormat pixels : pixel_formats) {
            const bool offered = pixels != PixelFormat::mjpeg;
            EXPECT_EQ(formats.contains(fourcc_of(pixels)), offered) << name_of(pixels);
        }
        return;
    }
    FAIL() << "not listed";
}

TEST_F(Vivid, EveryFormatAndMemory_WhiteIsWhiteAndBlackIsBlack) {
    for (const PixelFormat pixels : pixel_formats) {
        if (pixels == PixelFormat::mjpeg) continue;  // not offered
        for (const Memory memory : {Memory::mapped, Memory::user}) {
            CaptureSettings with = settings();
            with.pixels = pixels;
            with.memory = memory;
            const std::string what =
                fmt::format("{} {}", name_of(pixels), memory == Memory::user ? "userptr" : "mmap");
            SCOPED_TRACE(what);
            // YUYV has the limited range of television, 16 to 235.
            const bool limited = pixels == PixelFormat::yuyv;
            for (const auto& [pattern, expected] :
                 {std::pair(white, limited ? 235 : 255), std::pair(black, limited ? 16 : 0)}) {
                set("Test Pattern", pattern);
                V4l2Camera camera(node, with);
                const double mean = mean_of(camera);
                EXPECT_NEAR(mean, expected, 2.0) << "vivid's own rounding is 2 levels off";
                EXPECT_THAT(camera.notes().front(),
                            HasSubstr(memory == Memory::user ? "own memory" : "the driver's memory"));
                std::cout << what << ": " << (pattern == white ? "white " : "black ") << mean << '\n';
            }
        }
    }
}

TEST_F(Vivid, Gain_IsFixedAndReadsBack) {
    CaptureSettings with = settings();
    with.gain = 42;
    const V4l2Camera camera(node, with);
    EXPECT_THAT(camera.notes(),
                AllOf(Contains("\"Gain, Automatic\" fixed at 0"), Contains("\"Gain\" fixed at 42")));
}

TEST_F(Vivid, DroppedBuffers_AreCountedAsLost) {
    set("Percentage of Dropped Buffers", 50);
    V4l2Camera camera(node, settings());
    const std::uint64_t first = next_frame(camera).sequence;
    std::uint64_t last = first;
    while (last < first + 120) last = next_frame(camera).sequence;
    const FrameCounts counts = camera.counts();
    std::cout << "of " << last + 1 << " frames " << counts.lost << " lost, " << counts.handed_out << " used, "
              << counts.skipped << " skipped\n";
    const double share = static_cast<double>(counts.lost) / static_cast<double>(last + 1);
    EXPECT_NEAR(share, 0.5, 4.0 * 0.5 / std::sqrt(static_cast<double>(last + 1)))
        << "four deviations of a coin's";
    // What came after `last` in the meantime can only add.
    EXPECT_GE(counts.lost + counts.handed_out + counts.skipped, last + 1);
}

/// A camera that let frames lie until somebody asks would lose all that its buffers do not hold.
TEST_F(Vivid, NoFramesDropped_NoneLostThoughNobodyAsksForAWhile) {
    V4l2Camera camera(node, settings());
    (void)next_frame(camera);
    ASSERT_TRUE(wait_until([&] { return camera.counts().skipped >= 60; }));
    const Frame frame = next_frame(camera);
    EXPECT_LE(camera.counts().lost, 6U) << "vivid itself leaves a frame out where the machine stands still";
    EXPECT_GE(frame.sequence, 60U) << "the newest, not the oldest that was kept";
}

TEST_F(Vivid, StampsOfBothKinds_AreTakenToMidExposure) {
    for (const int source : {0, 1}) {
        set("Timestamp Source", source);
        V4l2Camera camera(node, settings());
        for (int k = 0; k < 5; ++k) {
            const Frame frame = next_frame(camera);
            EXPECT_LE(frame.time_ns, frame.arrival_ns);
            EXPECT_GT(frame.time_ns, frame.arrival_ns - 2 * ns_per_s);
        }
        EXPECT_EQ(camera.counts().unstamped, 0U);
    }
}

TEST_F(Vivid, StampsOfAnotherTime_AreNotBelieved) {
    set("Wrap Timestamp", 2);
    V4l2Camera camera(node, settings());
    const Frame frame = next_frame(camera);
    EXPECT_EQ(frame.time_ns, frame.arrival_ns - 30 * ns_per_ms);
    EXPECT_GE(camera.counts().unstamped, 1U);
}

TEST_F(Vivid, ErrorInAFrame_LeavesThatFrameOut) {
    V4l2Camera camera(node, settings());
    (void)next_frame(camera);
    press("Inject V4L2_BUF_FLAG_ERROR");
    EXPECT_TRUE(wait_until([&] { return camera.counts().damaged == 1; }));
    (void)next_frame(camera);
    EXPECT_EQ(camera.counts().damaged, 1U);
}

TEST_F(Vivid, RequestsThatFail_AreFaultsThatNameTheRequest) {
    press("Inject VIDIOC_STREAMON Error");
    EXPECT_THAT(fault_of(settings()),
                AllOf(HasSubstr(node), HasSubstr("VIDIOC_STREAMON"), HasSubstr("Invalid argument")));
    press("Inject VIDIOC_QBUF Error");
    EXPECT_THAT(fault_of(settings()), HasSubstr("VIDIOC_QBUF"));
    EXPECT_EQ(fault_of(settings()), "") << "and then it works again";
}

TEST_F(Vivid, DriversMemoryRefused_OwnIsTheFallback) {
    press("Inject VIDIOC_REQBUFS Error");
    V4l2Camera camera(node, settings());
    EXPECT_THAT(camera.notes().front(), HasSubstr("own memory"));
    (void)next_frame(camera);
}

TEST_F(Vivid, FatalError_EndsTheStreamWithItsReason) {
    V4l2Camera camera(node, settings());
    (void)next_frame(camera);
    press("Inject Fatal Streaming Error");
    const auto got = failure_of(camera);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().reason, Reason::device);
    std::cout << got.error().text << '\n';
}

/// From the fault to the failure, on the wall clock of the emulated machine.
class Disconnected : public Vivid {
  protected:
    static Failure failure_after_disconnect(V4l2Camera& camera) {
        (void)next_frame(camera);
        press("Disconnect");
        const auto pressed = std::chrono::steady_clock::now();
        const auto got = failure_of(camera);
        const auto after = std::chrono::steady_clock::now() - pressed;
        EXPECT_FALSE(got);
        if (got) return {Reason::stopped, ""};
        std::cout << std::chrono::duration<double>(after).count() << " s after: " << got.error().text << '\n';
        return got.error();
    }
};

TEST_F(Disconnected, WithoutReconnection_SaysThatTheCameraIsGone) {
    V4l2Camera camera(node, settings());
    const Failure why = failure_after_disconnect(camera);
    EXPECT_EQ(why.reason, Reason::device);
    EXPECT_THAT(why.text, HasSubstr("gone"));
}

TEST_F(Disconnected, WithReconnection_GoesOn) {
    CaptureSettings with = settings();
    with.reconnect_s = 60.0;
    V4l2Camera camera(node, with);
    const std::uint64_t before = next_frame(camera).sequence;
    press("Disconnect");
    ASSERT_TRUE(wait_until([&] { return camera.counts().reconnects == 1; }));
    EXPECT_GT(next_frame(camera).sequence, before);
}

TEST_F(Vivid, SourceChanges_SaysSo) {
    choose_input(hdmi_input);
    const auto device = Device::open(node);
    ASSERT_TRUE(device);
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    ASSERT_EQ(device->request(VIDIOC_G_FMT, &format), 0);
    CaptureSettings with = settings();
    with.width_px = static_cast<int>(format.fmt.pix.width);
    with.height_px = static_cast<int>(format.fmt.pix.height);
    V4l2Camera camera(node, with);
    (void)next_frame(camera);
    set("DV Timings Signal Mode", 1);  // no signal
    const auto got = failure_of(camera);
    set("DV Timings Signal Mode", 0);
    ASSERT_FALSE(got);
    EXPECT_THAT(got.error().text, HasSubstr("the source changed under way"));
}

TEST_F(Vivid, SizeThatItDoesNotHave_SaysWhichAreAllowed) {
    CaptureSettings with = settings();
    with.width_px = 333;
    try {
        const V4l2Camera camera(node, with);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("camera.width_px"), HasSubstr("640x480")));
    }
}

}  // namespace
}  // namespace fidservo::vision::v4l2
