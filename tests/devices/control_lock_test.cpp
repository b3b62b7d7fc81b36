// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/control_lock.h"

#include "core/input_error.h"
#include "tests/devices/fake_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::vision::v4l2 {
namespace {

using devices::FakeCamera;
using devices::FakeProperties;
using ::testing::HasSubstr;

CaptureSettings settings_of(double exposure_s) {
    CaptureSettings settings;
    settings.exposure_s = exposure_s;
    return settings;
}

ControlLock lock_on(const CaptureSettings& settings) {
    const auto device = Device::open("/dev/video0");
    return lock_controls(device.value(), settings);
}

std::string refusal_of(const CaptureSettings& settings) {
    try {
        (void)lock_on(settings);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ControlLock, Webcam_AutomaticsOffValuesSetAndReadBack) {
    const FakeCamera camera(devices::webcam());
    CaptureSettings settings = settings_of(0.002);
    settings.gain = 10;
    settings.focus = 35;
    const ControlLock lock = lock_on(settings);
    EXPECT_EQ(camera.control(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
    EXPECT_EQ(camera.control(V4L2_CID_FOCUS_AUTO), 0);
    EXPECT_EQ(camera.control(V4L2_CID_AUTO_WHITE_BALANCE), 0);
    EXPECT_EQ(camera.control(V4L2_CID_EXPOSURE_ABSOLUTE), 20);
    EXPECT_EQ(camera.control(V4L2_CID_GAIN), 10);
    EXPECT_EQ(camera.control(V4L2_CID_FOCUS_ABSOLUTE), 35);
    EXPECT_EQ(lock.locked.size(), 6U);
    EXPECT_DOUBLE_EQ(lock.exposure_s.value(), 0.002);
}

TEST(ControlLock, ExposureBetweenSteps_IsTheNearest) {
    const FakeCamera camera(devices::webcam());
    EXPECT_DOUBLE_EQ(lock_on(settings_of(0.00234)).exposure_s.value(), 0.0023);
}

TEST(ControlLock, GainNotGiven_StaysAndIsVerified) {
    const FakeCamera camera(devices::webcam());
    const ControlLock lock = lock_on(settings_of(0.002));
    EXPECT_EQ(camera.control(V4L2_CID_GAIN), 64);
    EXPECT_TRUE(std::ranges::any_of(lock.locked, [](const LockedControl& control) {
        return control.name == "Gain" && control.value == 64;
    }));
}

TEST(ControlLock, NoControls_NothingLockedNoExposure) {
    const FakeCamera camera(devices::grey_camera());
    const ControlLock lock = lock_on(settings_of(0.002));
    EXPECT_TRUE(lock.locked.empty());
    EXPECT_FALSE(lock.exposure_s);
}

TEST(ControlLock, ValueNotAllowed_NamesKeyAndRange) {
    const FakeCamera camera(devices::webcam());
    EXPECT_THAT(refusal_of(settings_of(0.5)),
                HasSubstr("camera.exposure_s: 0.5: /dev/video0 exposes from 0.0003 to 0.2047 s"));
    CaptureSettings settings = settings_of(0.002);
    settings.gain = 101;
    EXPECT_THAT(refusal_of(settings),
                HasSubstr("camera.capture.gain: 101: /dev/video0 has \"Gain\" from 0 to 100"));
    settings.gain = 100;
    settings.focus = 33;
    EXPECT_THAT(refusal_of(settings), HasSubstr("from 0 to 250 in steps of 5"));
}

TEST(ControlLock, ControlThatIsNotThere_IsRefusedWhereAskedFor) {
    const FakeCamera camera(devices::grey_camera());
    CaptureSettings settings = settings_of(0.002);
    settings.focus = 3;
    EXPECT_THAT(refusal_of(settings),
                HasSubstr("camera.capture.focus: 3: /dev/video0 has no control for it"));
}

TEST(ControlLock, ControlThatKeepsItsOwnValue_IsAFault) {
    FakeProperties properties = devices::webcam();
    properties.controls[1].deaf = true;
    const FakeCamera camera(properties);
    CaptureSettings settings = settings_of(0.002);
    settings.gain = 10;
    try {
        (void)lock_on(settings);
        FAIL() << "a gain that was not taken is a fault";
    } catch (const RunFault& fault) {
        EXPECT_THAT(fault.what(), HasSubstr("\"Gain\" was set to 10 and reads back 64"));
    }
}

}  // namespace
}  // namespace fidservo::vision::v4l2
