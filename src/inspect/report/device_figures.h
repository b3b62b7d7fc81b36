// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Statistics of a run's devices: the control loop's punctuality, the camera's frames.
#include "control/loop_statistics.h"
#include "vision/camera.h"

#include <optional>
#include <string>

namespace fidservo::inspect {

/// Counted since the run was last resumed. Empty in simulated time, or with images from disk.
struct DeviceFigures {
    std::optional<control::LoopStatistics> loop;
    std::optional<vision::FrameCounts> frames;
};

/// Table and histogram.
std::string loop_html(const control::LoopStatistics& loop);

/// Table.
std::string frames_html(const vision::FrameCounts& frames);

}  // namespace fidservo::inspect
