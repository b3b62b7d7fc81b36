// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera's controls: gain, exposure and whatever else the driver lets one set.
#include "vision/v4l2/device.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::vision::v4l2 {

enum class ControlKind { integer, boolean, menu, button, other };

struct MenuItem {
    std::int64_t index;
    std::string text;
};

struct Control {
    std::uint32_t id;
    std::string name;  ///< as the driver names it
    ControlKind kind;
    std::int64_t minimum, maximum, step, standard;
    /// Present value; empty for a control without one, or if it cannot be read.
    std::optional<std::int64_t> value;
    bool writable;               ///< whether it can be set at present
    std::vector<MenuItem> menu;  ///< the items of a menu
};

/// All controls that are not disabled, in the driver's order.
std::vector<Control> list_controls(const Device& device);

/// The control with this id; empty if the camera does not have it.
std::optional<Control> find_control(const Device& device, std::uint32_t id);

/// @return 0, or the system's error number
int set_control(const Device& device, std::uint32_t id, std::int64_t value);

}  // namespace fidservo::vision::v4l2
