// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fake cameras that several tests use.
#include "tests/devices/fake_camera.h"

#include <linux/videodev2.h>

namespace fidservo::devices {

inline FakeProperties grey_camera() {
    FakeProperties properties;
    properties.formats = {{V4L2_PIX_FMT_GREY, 64, 48, 64}};
    return properties;
}

/// A webcam's controls, with all automatic modes on.
inline FakeProperties webcam() {
    FakeProperties properties;
    properties.formats = {{V4L2_PIX_FMT_MJPEG, 64, 48, 0}, {V4L2_PIX_FMT_YUYV, 64, 48, 128}};
    properties.controls = {
        {V4L2_CID_AUTO_WHITE_BALANCE, "White Balance, Automatic", V4L2_CTRL_TYPE_BOOLEAN, 0, 1, 1, 1},
        {V4L2_CID_GAIN, "Gain", V4L2_CTRL_TYPE_INTEGER, 0, 100, 1, 64},
        {V4L2_CID_EXPOSURE_AUTO, "Auto Exposure", V4L2_CTRL_TYPE_MENU, 0, 3, 1, 3},
        {V4L2_CID_EXPOSURE_ABSOLUTE, "Exposure Time, Absolute", V4L2_CTRL_TYPE_INTEGER, 3, 2047, 1, 250},
        {V4L2_CID_FOCUS_ABSOLUTE, "Focus, Absolute", V4L2_CTRL_TYPE_INTEGER, 0, 250, 5, 0},
        {V4L2_CID_FOCUS_AUTO, "Focus, Automatic Continuous", V4L2_CTRL_TYPE_BOOLEAN, 0, 1, 1, 1}};
    return properties;
}

}  // namespace fidservo::devices
