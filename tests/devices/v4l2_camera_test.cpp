// SPDX-License-Identifier: GPL-3.0-or-later
// The whole camera against a driver made by umockdev. Waits end with what they wait for; their limit of 20 s
// is for the case that it never comes.
#include "vision/v4l2/v4l2_camera.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "tests/devices/fake_models.h"
#include "tests/next_frame.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <span>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fidservo::vision::v4l2 {
namespace {

using devices::FakeCamera;
using devices::FakeFrame;
using devices::FakeProperties;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::size_t frame_bytes = 64 * 48;
constexpr std::uint32_t monotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;

CaptureSettings settings() {
    CaptureSettings settings;
    settings.width_px = 64;
    settings.height_px = 48;
    settings.frame_rate_hz = 50.0;
    settings.exposure_s = 0.002;
    settings.latency_s = 0.030;
    return settings;
}

/// All pixels have one value.
FakeFrame even_frame(std::uint32_t sequence, int value) {
    return {std::vector<std::byte>(frame_bytes, static_cast<std::byte>(value)), sequence, monotonic,
            monotonic_now_ns() / 1000};
}

int value_of(const Frame& frame) {
    double least = 0;
    double most = 1;
    cv::minMaxLoc(frame.image, &least, &most);
    EXPECT_EQ(least, most);
    return static_cast<int>(least);
}

TEST(V4l2Camera, NothingExposed_NoFrame) {
    const FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    const auto frame = camera.poll(monotonic_now_ns());
    ASSERT_TRUE(frame);
    EXPECT_FALSE(*frame);
}

TEST(V4l2Camera, FrameThatCameAfterTheTimeAskedFor_IsKeptUntilThen) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    const TimeNs before_ns = monotonic_now_ns();
    fake.expose(even_frame(0, 5));
    ASSERT_TRUE(wait_until([&] { return fake.waiting() == 0; }));
    const auto early = camera.poll(before_ns);
    EXPECT_TRUE(early && !*early);
    EXPECT_EQ(value_of(next_frame(camera)), 5);
}

TEST(V4l2Camera, SeveralFrames_TheNewestWinsAndTheOthersAreSkipped) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    for (int k = 0; k < 4; ++k) fake.expose(even_frame(static_cast<std::uint32_t>(k), 10 + k));
    ASSERT_TRUE(wait_until([&] { return camera.counts().skipped == 3; }));
    const Frame frame = next_frame(camera);
    EXPECT_EQ(value_of(frame), 13);
    EXPECT_EQ(frame.sequence, 3U);
    EXPECT_EQ(camera.counts().lost, 0U);
    const auto again = camera.poll(monotonic_now_ns());
    EXPECT_TRUE(again && !*again) << "a frame is handed out once";
}

TEST(V4l2Camera, GreyFrame_StaysInTheDriversBufferUntilLetGo) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    const std::size_t buffers = fake.queued_buffers();
    fake.expose(even_frame(0, 77));
    {
        const Frame frame = next_frame(camera);
        const cv::Mat part = frame.image(cv::Rect(8, 8, 4, 4));
        EXPECT_EQ(fake.queued_buffers(), buffers - 1) << "held: no copy was made";
        EXPECT_EQ(value_of(frame), 77);
    }
    EXPECT_EQ(fake.queued_buffers(), buffers);
}

TEST(V4l2Camera, GreyFrameOfV4l2loopback_IsCopied) {
    devices::FakeProperties properties = devices::grey_camera();
    properties.driver = "v4l2 loopback";
    FakeCamera fake(properties);
    V4l2Camera camera("/dev/video0", settings());
    const std::size_t buffers = fake.queued_buffers();
    fake.expose(even_frame(0, 77));
    const Frame frame = next_frame(camera);
    EXPECT_EQ(fake.queued_buffers(), buffers);
    EXPECT_EQ(value_of(frame), 77);
}

TEST(V4l2Camera, ManyFramesKept_AreCopiedBeforeTheDriverRunsOut) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    std::vector<Frame> kept;
    for (int k = 0; k < 20; ++k) {
        fake.expose(even_frame(static_cast<std::uint32_t>(k), 100 + k));
        kept.push_back(next_frame(camera));
        EXPECT_GE(fake.queued_buffers(), 2U);
    }
    for (int k = 0; k < 20; ++k) EXPECT_EQ(value_of(kept[static_cast<std::size_t>(k)]), 100 + k);
    EXPECT_EQ(fake.dropped(), 0U);
}

TEST(V4l2Camera, KeptFrame_OutlivesTheCamera) {
    FakeCamera fake(devices::grey_camera());
    Frame frame;
    {
        V4l2Camera camera("/dev/video0", settings());
        fake.expose(even_frame(0, 42));
        frame = next_frame(camera);
    }
    EXPECT_EQ(value_of(frame), 42);
}

TEST(V4l2Camera, ProgramsMemory_WorksAndIsTheFallback) {
    for (const bool driver_maps : {true, false}) {
        FakeProperties properties = devices::grey_camera();
        properties.maps = driver_maps;
        properties.takes_memory = true;
        FakeCamera fake(properties);
        CaptureSettings with = settings();
        with.memory = driver_maps ? Memory::user : Memory::mapped;
        V4l2Camera camera("/dev/video0", with);
        EXPECT_THAT(camera.notes().front(), HasSubstr("own memory"));
        for (int k = 0; k < 3; ++k) {
            fake.expose(even_frame(static_cast<std::uint32_t>(k), 30 + k));
            EXPECT_EQ(value_of(next_frame(camera)), 30 + k);
        }
    }
}

TEST(V4l2Camera, DriverTakesNoMemory_MappedIsTheFallback) {
    FakeProperties properties = devices::grey_camera();
    properties.takes_memory = false;
    FakeCamera fake(properties);
    CaptureSettings with = settings();
    with.memory = Memory::user;
    V4l2Camera camera("/dev/video0", with);
    fake.expose(even_frame(0, 9));
    EXPECT_EQ(value_of(next_frame(camera)), 9);
    EXPECT_THAT(camera.notes().front(), HasSubstr("the driver's memory"));
}

TEST(V4l2Camera, Stamp_IsTakenToTheMiddleOfTheExposureThatWasSet) {
    FakeProperties properties = devices::webcam();
    FakeCamera fake(properties);
    CaptureSettings with = settings();
    with.exposure_s = 0.0102;
    with.pixels = PixelFormat::yuyv;
    V4l2Camera camera("/dev/video0", with);
    FakeFrame frame = even_frame(0, 128);
    frame.bytes.resize(2 * frame_bytes);
    frame.flags = monotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    frame.stamp_us -= 50'000;
    const TimeNs stamp_ns = frame.stamp_us * 1000;
    fake.expose(frame);
    EXPECT_EQ(next_frame(camera).time_ns, stamp_ns + 5'100'000);
    frame.flags = monotonic | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    fake.expose(frame);
    EXPECT_EQ(next_frame(camera).time_ns, stamp_ns - 5'100'000);
    frame.flags = V4L2_BUF_FLAG_TIMESTAMP_COPY;
    fake.expose(frame);
    const Frame unstamped = next_frame(camera);
    EXPECT_EQ(unstamped.time_ns, unstamped.arrival_ns - 30'000'000);
    EXPECT_EQ(camera.counts().unstamped, 1U);
}

TEST(V4l2Camera, GapsInTheNumbers_CountAsLost) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    for (const std::uint32_t number : {5U, 6U, 9U, 10U, 20U}) {
        fake.expose(even_frame(number, 1));
        (void)next_frame(camera);
    }
    EXPECT_EQ(camera.counts().lost, 11U);
    EXPECT_EQ(camera.counts().handed_out, 5U);
}

TEST(V4l2Camera, DamagedFrames_AreLeftOut) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    FakeFrame marked = even_frame(0, 1);
    marked.flags |= V4L2_BUF_FLAG_ERROR;
    FakeFrame short_one = even_frame(1, 2);
    short_one.bytes.resize(100);
    fake.expose(marked);
    fake.expose(short_one);
    fake.expose(even_frame(2, 3));
    EXPECT_EQ(value_of(next_frame(camera)), 3);
    EXPECT_EQ(camera.counts().damaged, 2U);
    EXPECT_EQ(camera.counts().lost, 0U);
}

TEST(V4l2Camera, OnlyDamagedFrames_EndInATimeOutThatSaysSo) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    std::uint32_t number = 0;
    Result<std::optional<Frame>> got = std::optional<Frame>();
    ASSERT_TRUE(wait_until([&] {
        FakeFrame frame = even_frame(number++, 1);
        frame.flags |= V4L2_BUF_FLAG_ERROR;
        fake.expose(frame);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        got = camera.poll(monotonic_now_ns());
        return !got;
    }));
    EXPECT_EQ(got.error().reason, Reason::timeout);
    EXPECT_THAT(got.error().text, AllOf(HasSubstr("no whole frame for 1.1 s"), HasSubstr("damaged)")));
}

TEST(V4l2Camera, NoFrames_TimeOut) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    const auto got = next(camera);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().reason, Reason::timeout);
    EXPECT_FALSE(camera.poll(monotonic_now_ns())) << "for good";
}

TEST(V4l2Camera, Unplugged_SaysSo) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    fake.expose(even_frame(0, 1));
    (void)next_frame(camera);
    fake.unplug();
    const auto got = next(camera);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().reason, Reason::device);
    EXPECT_THAT(got.error().text, HasSubstr("the camera is gone (unplugged?)"));
}

TEST(V4l2Camera, UnpluggedAndBack_GoesOnWhereAllowed) {
    FakeCamera fake(devices::webcam());
    CaptureSettings with = settings();
    with.reconnect_s = 20.0;
    with.pixels = PixelFormat::yuyv;
    V4l2Camera camera("/dev/video0", with);
    FakeFrame frame = even_frame(900, 1);
    frame.bytes.resize(2 * frame_bytes);
    fake.expose(frame);
    (void)next_frame(camera);
    fake.unplug();
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    const auto away = camera.poll(monotonic_now_ns());
    EXPECT_TRUE(away && !*away) << "no frames, and no failure, while it is waited for";
    fake.plug_in();
    ASSERT_TRUE(wait_until([&] { return camera.counts().reconnects == 1; }));
    frame.sequence = 0;
    fake.expose(frame);
    EXPECT_EQ(next_frame(camera).sequence, 1U);
    EXPECT_EQ(camera.counts().lost, 0U);
    EXPECT_EQ(fake.control(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
}

TEST(V4l2Camera, UnpluggedAndNotBackInTime_SaysHowLongItWaited) {
    FakeCamera fake(devices::grey_camera());
    CaptureSettings with = settings();
    with.reconnect_s = 0.3;
    V4l2Camera camera("/dev/video0", with);
    fake.unplug();
    const auto got = next(camera);
    ASSERT_FALSE(got);
    EXPECT_THAT(got.error().text, AllOf(HasSubstr("unplugged"), HasSubstr("not back after 0.3 s")));
}

TEST(V4l2Camera, FormatChangedUnderWay_SaysFromWhatToWhat) {
    FakeCamera fake(devices::grey_camera());
    V4l2Camera camera("/dev/video0", settings());
    fake.change_format({V4L2_PIX_FMT_GREY, 32, 24, 32});
    FakeFrame smaller = even_frame(0, 1);
    smaller.bytes.resize(32 * 24);
    fake.expose(smaller);
    const auto got = next(camera);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().reason, Reason::device);
    EXPECT_THAT(got.error().text, HasSubstr("from 64 x 48 px GREY to 32 x 24 px GREY"));
}

FakeFrame jpeg_frame(std::uint32_t sequence, int rows, int cols) {
    std::vector<std::uint8_t> jpeg;
    cv::imencode(".jpg", cv::Mat(rows, cols, CV_8UC1, cv::Scalar(90)), jpeg);
    FakeFrame frame = even_frame(sequence, 0);
    const auto bytes = std::as_bytes(std::span(jpeg));
    frame.bytes.assign(bytes.begin(), bytes.end());
    return frame;
}

TEST(V4l2Camera, Mjpeg_DecodedDamagedAndOfAnotherSize) {
    FakeCamera fake(devices::webcam());
    CaptureSettings with = settings();
    with.pixels = PixelFormat::mjpeg;
    V4l2Camera camera("/dev/video0", with);
    fake.expose(jpeg_frame(0, 48, 64));
    EXPECT_EQ(value_of(next_frame(camera)), 90);
    FakeFrame cut = jpeg_frame(1, 48, 64);
    cut.bytes.resize(cut.bytes.size() / 2);
    fake.expose(cut);
    ASSERT_TRUE(wait_until([&] {
        const auto none = camera.poll(monotonic_now_ns());
        EXPECT_TRUE(none && !*none);
        return camera.counts().damaged == 1;
    }));
    fake.expose(jpeg_frame(2, 24, 32));
    const auto got = next(camera);
    ASSERT_FALSE(got);
    EXPECT_THAT(got.error().text, HasSubstr("from 64 x 48 px MJPEG to 32 x 24 px"));
}

template <class Error>
std::string refusal_of(const CaptureSettings& settings) {
    try {
        const V4l2Camera camera("/dev/video0", settings);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(V4l2Camera, WrongSettings_NameKeyValueAndWhatIsAllowed) {
    const FakeCamera fake(devices::webcam());
    CaptureSettings with = settings();
    with.width_px = 640;
    with.height_px = 480;
    with.pixels = PixelFormat::yuyv;
    EXPECT_THAT(
        refusal_of<InputError>(with),
        HasSubstr(
            "camera.width_px, height_px: 640 x 480: /dev/video0 has no such size in YUYV; allowed: 64x48"));
    with.pixels = PixelFormat::grey;
    EXPECT_THAT(
        refusal_of<InputError>(with),
        HasSubstr("camera.capture.format: GREY: /dev/video0 does not offer it; allowed: MJPEG, YUYV"));
}

TEST(V4l2Camera, StreamDoesNotStart_IsAFaultThatNamesTheRequest) {
    FakeProperties properties = devices::grey_camera();
    properties.stream_error = EINVAL;
    const FakeCamera fake(properties);
    EXPECT_THAT(refusal_of<RunFault>(settings()),
                AllOf(HasSubstr("/dev/video0"), HasSubstr("VIDIOC_STREAMON"), HasSubstr("Invalid argument")));
}

TEST(V4l2Camera, NoFormatGiven_YuyvBeforeMjpeg) {
    const FakeCamera fake(devices::webcam());
    const V4l2Camera camera("/dev/video0", settings());
    EXPECT_THAT(camera.notes().front(), HasSubstr("Fake camera: 64 x 48 px YUYV"));
}

}  // namespace
}  // namespace fidservo::vision::v4l2
