// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/capability.h"

#include "core/failure.h"

#include <linux/videodev2.h>

namespace fidservo::vision::v4l2 {

namespace {

/// From a field of fixed size, which a driver may fill to the last byte.
template <std::size_t n>
std::string text_of_field(const __u8 (&field)[n]) {
    std::string text(reinterpret_cast<const char*>(field), n);
    return text.substr(0, text.find('\0'));
}

}  // namespace

Result<Capability> capability_of(const Device& device) {
    v4l2_capability answer{};
    if (const int error = device.request(VIDIOC_QUERYCAP, &answer); error != 0)
        return failure(Reason::device, device.refusal("not a video device (VIDIOC_QUERYCAP)", error));
    const std::uint32_t can =
        (answer.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? answer.device_caps : answer.capabilities;
    return Capability{text_of_field(answer.driver), text_of_field(answer.card),
                      text_of_field(answer.bus_info), (can & V4L2_CAP_VIDEO_CAPTURE) != 0,
                      (can & V4L2_CAP_STREAMING) != 0};
}

}  // namespace fidservo::vision::v4l2
