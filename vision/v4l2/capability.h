// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/result.h"
#include "vision/v4l2/device.h"

#include <string>

namespace fidservo::vision::v4l2 {

/// Who a node is, and what it can do.
struct Capability {
    std::string driver, card, bus;
    bool captures = false;  ///< video, one plane
    bool streams = false;
};

/// Fails with Reason::device: not a video node, or gone.
Result<Capability> capability_of(const Device& device);

}  // namespace fidservo::vision::v4l2
