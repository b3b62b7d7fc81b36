// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo cameras: the V4L2 devices of this machine.
#include "src/cli/commands.h"
#include "vision/v4l2/camera_list.h"

#include <memory>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace fidservo {

namespace {

namespace v4l2 = vision::v4l2;
using nlohmann::ordered_json;

bool is_understood(const v4l2::OfferedFormat& format) {
    return v4l2::pixel_format_of(format.fourcc).has_value();
}

/// As rig files call it, where it is one that is understood.
std::string name_of(const v4l2::OfferedFormat& format) {
    const auto pixels = v4l2::pixel_format_of(format.fourcc);
    return pixels ? std::string(v4l2::name_of(*pixels)) : v4l2::fourcc_text(format.fourcc);
}

std::string sizes_of(const v4l2::OfferedFormat& format) {
    std::vector<std::string> sizes;
    for (const v4l2::OfferedSize& size : format.sizes)
        sizes.push_back(size.rates_hz.empty() ? v4l2::size_text(size)
                                              : fmt::format("{} at {:.4g} Hz", v4l2::size_text(size),
                                                            fmt::join(size.rates_hz, ", ")));
    return sizes.empty() ? "the driver does not list sizes" : fmt::format("{}", fmt::join(sizes, "; "));
}

std::string value_of(const v4l2::Control& control) {
    if (control.kind == v4l2::ControlKind::button) return "button";
    if (!control.value) return "no value that can be shown";
    if (control.kind == v4l2::ControlKind::menu) {
        std::vector<std::string> items;
        for (const v4l2::MenuItem& item : control.menu)
            items.push_back(fmt::format("{} {}", item.index, item.text));
        return fmt::format("{} of {}", *control.value, fmt::join(items, ", "));
    }
    const std::string range = control.kind == v4l2::ControlKind::boolean
                                  ? "0 or 1"
                                  : fmt::format("{} to {}", control.minimum, control.maximum);
    return fmt::format("{} of {}{}", *control.value, range,
                       control.step > 1 ? fmt::format(" in steps of {}", control.step) : "");
}

void print_camera(const v4l2::ListedCamera& camera) {
    fmt::print("v4l2:{}  {}\n", camera.node.string(), camera.trouble.empty() ? camera.card : camera.trouble);
    if (!camera.by_id.empty()) fmt::print("  by id    v4l2:{}\n", camera.by_id.string());
    if (!camera.trouble.empty()) return;
    fmt::print("  driver   {}, {}\n", camera.driver, camera.bus);
    std::vector<std::string> others;
    for (const v4l2::OfferedFormat& format : camera.formats) {
        if (is_understood(format))
            fmt::print("  format   {:<6} {}\n", name_of(format), sizes_of(format));
        else
            others.push_back(name_of(format));
    }
    if (!others.empty()) fmt::print("  others   {} (not understood)\n", fmt::join(others, ", "));
    for (const v4l2::Control& control : camera.controls)
        fmt::print("  control  {:<32} {}{}\n", control.name, value_of(control),
                   control.writable ? "" : ", read only");
}

ordered_json json_of(const v4l2::OfferedFormat& format) {
    ordered_json sizes = ordered_json::array();
    for (const v4l2::OfferedSize& size : format.sizes) {
        ordered_json json{{"width_px", size.most_width_px}, {"height_px", size.most_height_px}};
        if (!size.is_single())
            json.update({{"least_width_px", size.least_width_px},
                         {"least_height_px", size.least_height_px},
                         {"step_width_px", size.step_width_px},
                         {"step_height_px", size.step_height_px}});
        json["rates_hz"] = size.rates_hz;
        sizes.push_back(std::move(json));
    }
    return {{"format", name_of(format)},
            {"understood", is_understood(format)},
            {"description", format.description},
            {"sizes", std::move(sizes)}};
}

ordered_json json_of(const v4l2::Control& control) {
    ordered_json json{{"name", control.name},
                      {"id", control.id},
                      {"minimum", control.minimum},
                      {"maximum", control.maximum},
                      {"step", control.step},
                      {"default", control.standard},
                      {"value", control.value ? ordered_json(*control.value) : ordered_json()},
                      {"writable", control.writable}};
    for (const v4l2::MenuItem& item : control.menu) json["menu"][std::to_string(item.index)] = item.text;
    return json;
}

ordered_json json_of(const v4l2::ListedCamera& camera) {
    ordered_json json{{"camera", "v4l2:" + camera.node.string()}, {"by_id", camera.by_id.string()}};
    if (!camera.trouble.empty()) {
        json["trouble"] = camera.trouble;
        return json;
    }
    json.update({{"name", camera.card}, {"driver", camera.driver}, {"bus", camera.bus}});
    json["formats"] = json["controls"] = ordered_json::array();
    for (const v4l2::OfferedFormat& format : camera.formats) json["formats"].push_back(json_of(format));
    for (const v4l2::Control& control : camera.controls) json["controls"].push_back(json_of(control));
    return json;
}

int run_cameras(bool as_json) {
    const std::vector<v4l2::ListedCamera> cameras = v4l2::list_cameras();
    if (as_json) {
        ordered_json all = ordered_json::array();
        for (const v4l2::ListedCamera& camera : cameras) all.push_back(json_of(camera));
        fmt::print("{}\n", all.dump(1, ' ', false, ordered_json::error_handler_t::replace));
        return exit_done;
    }
    if (cameras.empty()) fmt::print("no camera found\n");
    for (const v4l2::ListedCamera& camera : cameras) print_camera(camera);
    return exit_done;
}

}  // namespace

void add_cameras(CLI::App& app, int& exit_code) {
    auto as_json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand(
        "cameras", "List the cameras of this machine (V4L2): formats, sizes, frame rates, controls");
    command->add_flag("--json", *as_json, "As JSON");
    add_example(*command, "fidservo cameras");
    command->callback([as_json, &exit_code] { exit_code = run_cameras(*as_json); });
}

}  // namespace fidservo
