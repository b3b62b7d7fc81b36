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
    std::string name;  ///< the driver's
    ControlKind kind;
    std::int64_t minimum, maximum, step, standard;
    std::optional<std::int64_t> value;  ///< now; nothing for what has none or cannot be read
    bool writable;                      ///< now
    std::vector<MenuItem> menu;         ///< of a menu, what it offers
};

/// All controls that are not disabled, in the driver's order.
std::vector<Control> list_controls(const Device& device);

/// One control; nothing if the camera does not have it.
std::optional<Control> find_control(const Device& device, std::uint32_t id);

/// @return 0, or the system's error number
int set_control(const Device& device, std::uint32_t id, std::int64_t value);

}  // namespace fidservo::vision::v4l2
