// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/controls.h"

#include <linux/videodev2.h>

namespace fidservo::vision::v4l2 {

namespace {

ControlKind kind_of(std::uint32_t type) {
    switch (type) {
        case V4L2_CTRL_TYPE_INTEGER:
        case V4L2_CTRL_TYPE_INTEGER64:
        case V4L2_CTRL_TYPE_BITMASK:
            return ControlKind::integer;
        case V4L2_CTRL_TYPE_BOOLEAN:
            return ControlKind::boolean;
        case V4L2_CTRL_TYPE_MENU:
        case V4L2_CTRL_TYPE_INTEGER_MENU:
            return ControlKind::menu;
        case V4L2_CTRL_TYPE_BUTTON:
            return ControlKind::button;
        default:
            return ControlKind::other;
    }
}

/// A request on a single control. @return 0, or the system's error number
int exchange(const Device& device, unsigned long code, v4l2_ext_control& control) {
    v4l2_ext_controls request{};
    request.which = V4L2_CTRL_WHICH_CUR_VAL;
    request.count = 1;
    request.controls = &control;
    return device.request(code, &request);
}

std::optional<std::int64_t> read_value(const Device& device, const v4l2_query_ext_ctrl& about) {
    if ((about.flags & V4L2_CTRL_FLAG_WRITE_ONLY) != 0) return std::nullopt;
    v4l2_ext_control control{};
    control.id = about.id;
    if (exchange(device, VIDIOC_G_EXT_CTRLS, control) != 0) return std::nullopt;
    if (about.type == V4L2_CTRL_TYPE_INTEGER64) return std::int64_t{control.value64};
    if (about.type == V4L2_CTRL_TYPE_BITMASK) return static_cast<std::uint32_t>(control.value);
    return std::int64_t{control.value};
}

std::vector<MenuItem> read_menu(const Device& device, const v4l2_query_ext_ctrl& about) {
    constexpr std::int64_t most_items = 256;
    std::vector<MenuItem> items;
    for (std::int64_t k = about.minimum; k <= about.maximum && k < about.minimum + most_items; ++k) {
        v4l2_querymenu item{};
        item.id = about.id;
        item.index = static_cast<std::uint32_t>(k);
        if (device.request(VIDIOC_QUERYMENU, &item) != 0) continue;
        items.push_back({k, about.type == V4L2_CTRL_TYPE_MENU ? reinterpret_cast<const char*>(item.name)
                                                              : std::to_string(item.value)});
    }
    return items;
}

Control control_of(const Device& device, const v4l2_query_ext_ctrl& about) {
    constexpr std::uint32_t locked = V4L2_CTRL_FLAG_READ_ONLY | V4L2_CTRL_FLAG_GRABBED;
    Control control{.id = about.id,
                    .name = about.name,
                    .kind = kind_of(about.type),
                    .minimum = about.minimum,
                    .maximum = about.maximum,
                    .step = static_cast<std::int64_t>(about.step),
                    .standard = about.default_value,
                    .value = {},
                    .writable = (about.flags & locked) == 0,
                    .menu = {}};
    if (control.kind == ControlKind::menu) control.menu = read_menu(device, about);
    if (control.kind != ControlKind::button && control.kind != ControlKind::other)
        control.value = read_value(device, about);
    return control;
}

}  // namespace

std::vector<Control> list_controls(const Device& device) {
    std::vector<Control> controls;
    v4l2_query_ext_ctrl about{};
    about.id = V4L2_CTRL_FLAG_NEXT_CTRL;
    for (std::uint32_t last = 0; device.request(VIDIOC_QUERY_EXT_CTRL, &about) == 0 && about.id > last;) {
        last = about.id;
        const bool heading = about.type == V4L2_CTRL_TYPE_CTRL_CLASS;
        if (!heading && (about.flags & V4L2_CTRL_FLAG_DISABLED) == 0)
            controls.push_back(control_of(device, about));
        about.id = last | V4L2_CTRL_FLAG_NEXT_CTRL;
    }
    return controls;
}

std::optional<Control> find_control(const Device& device, std::uint32_t id) {
    v4l2_query_ext_ctrl about{};
    about.id = id;
    if (device.request(VIDIOC_QUERY_EXT_CTRL, &about) != 0 || (about.flags & V4L2_CTRL_FLAG_DISABLED) != 0)
        return std::nullopt;
    return control_of(device, about);
}

int set_control(const Device& device, std::uint32_t id, std::int64_t value) {
    v4l2_ext_control control{};
    control.id = id;
    control.value = static_cast<std::int32_t>(value);
    return exchange(device, VIDIOC_S_EXT_CTRLS, control);
}

}  // namespace fidservo::vision::v4l2
