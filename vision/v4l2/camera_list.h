#pragma once
// The cameras of this machine.
#include "vision/v4l2/controls.h"
#include "vision/v4l2/format_list.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::vision::v4l2 {

struct ListedCamera {
    std::filesystem::path node;  ///< /dev/video0
    std::filesystem::path
        by_id;  ///< a path that stays the same across restarts; empty if the system gives none
    std::string driver, card, bus;
    std::vector<OfferedFormat> formats;
    std::vector<Control> controls;
    std::string trouble;  ///< why it could not be asked; then all of the above but the paths is empty
};

/// All that capture video, by number. Nodes that do not (outputs, metadata) are left out. No camera is
/// started.
std::vector<ListedCamera> list_cameras();

/// The link in /dev/v4l/by-id that leads to a node; empty if there is none.
std::filesystem::path by_id_of(const std::filesystem::path& node);

}  // namespace fidservo::vision::v4l2
