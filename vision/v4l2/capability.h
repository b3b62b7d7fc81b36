// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/result.h"
#include "vision/v4l2/device.h"

#include <string>

namespace fidservo::vision::v4l2 {

/// Name and capabilities of a video node.
struct Capability {
    std::string driver, card, bus;
    bool captures = false;  ///< it captures video, in one plane
    bool streams = false;
};

/// Fails with Reason::device if it is no video node, or gone.
Result<Capability> capability_of(const Device& device);

}  // namespace fidservo::vision::v4l2
