// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/camera_list.h"

#include "tests/devices/fake_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::vision::v4l2 {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(CameraList, Webcam_SaysAllThereIsToKnow) {
    const devices::FakeCamera fake(devices::webcam());
    const auto cameras = list_cameras();
    ASSERT_THAT(cameras, SizeIs(1));
    const ListedCamera& camera = cameras.front();
    EXPECT_EQ(camera.node, "/dev/video0");
    EXPECT_EQ(camera.by_id, "/dev/v4l/by-id/usb-Fake_camera-video-index0");
    EXPECT_EQ(camera.driver, "fake");
    EXPECT_EQ(camera.card, "Fake camera");
    EXPECT_THAT(camera.trouble, IsEmpty());
    ASSERT_THAT(camera.formats, SizeIs(2));
    EXPECT_EQ(fourcc_text(camera.formats[0].fourcc), "MJPG");
    ASSERT_THAT(camera.formats[1].sizes, SizeIs(1));
    EXPECT_EQ(size_text(camera.formats[1].sizes[0]), "64x48");
    EXPECT_THAT(camera.formats[1].sizes[0].rates_hz, ElementsAre(25.0, 50.0));
    ASSERT_THAT(camera.controls, SizeIs(6));
    const Control& gain = camera.controls[1];
    EXPECT_EQ(gain.name, "Gain");
    EXPECT_EQ(gain.minimum, 0);
    EXPECT_EQ(gain.maximum, 100);
    EXPECT_EQ(gain.value, 64);
}

TEST(CameraList, CameraThatDoesNotAnswer_SaysWhy) {
    devices::FakeCamera fake(devices::webcam());
    fake.unplug();
    const auto cameras = list_cameras();
    ASSERT_THAT(cameras, SizeIs(1));
    EXPECT_THAT(cameras.front().trouble, HasSubstr("/dev/video0"));
    EXPECT_THAT(cameras.front().trouble, HasSubstr("the camera is gone (unplugged?)"));
    EXPECT_THAT(cameras.front().formats, IsEmpty());
}

TEST(OfferedSize, Range_IncludesItsSteps) {
    const OfferedSize range{16, 8, 64, 48, 16, 8, {}};
    EXPECT_TRUE(range.includes(32, 16));
    EXPECT_FALSE(range.includes(32, 17));
    EXPECT_FALSE(range.includes(80, 16));
    EXPECT_EQ(size_text(range), "16x8 to 64x48 in steps of 16x8");
}

}  // namespace
}  // namespace fidservo::vision::v4l2
