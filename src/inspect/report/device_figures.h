// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the devices of a run did: the control loop's punctuality, the camera's frames.
#include "control/loop_statistics.h"
#include "vision/camera.h"

#include <optional>
#include <string>

namespace fidservo::inspect {

/// Since the run was last taken up. Empty where there is nothing to count: in simulated time, or on images
/// of the disk.
struct DeviceFigures {
    std::optional<control::LoopStatistics> loop;
    std::optional<vision::FrameCounts> frames;
};

/// Table and histogram.
std::string loop_html(const control::LoopStatistics& loop);

/// Table.
std::string frames_html(const vision::FrameCounts& frames);

}  // namespace fidservo::inspect
