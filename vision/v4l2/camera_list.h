// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The cameras of this computer.
#include "vision/v4l2/controls.h"
#include "vision/v4l2/format_list.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::vision::v4l2 {

/// A camera of this computer.
struct ListedCamera {
    std::filesystem::path node;  ///< /dev/video0
    std::filesystem::path
        by_id;  ///< a path that stays the same across restarts; empty if the system gives none
    /// Names of the driver, of the device, and of the bus address where it is plugged in.
    std::string driver, card, bus;
    std::vector<OfferedFormat> formats;  ///< what it can send
    std::vector<Control> controls;       ///< its controls
    /// Why the camera could not be queried; everything above but the paths is then empty.
    std::string trouble;
};

/// All nodes that capture video, by number; output and metadata nodes are left out. No camera is started.
std::vector<ListedCamera> list_cameras();

/// The link in /dev/v4l/by-id that leads to a node; empty if there is none.
std::filesystem::path by_id_of(const std::filesystem::path& node);

}  // namespace fidservo::vision::v4l2
