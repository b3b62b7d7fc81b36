// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/camera_choice.h"

#include "core/camera/camera_parameters.h"
#include "core/input_error.h"
#include "src/files/rig/capture_keys.h"
#include "vision/v4l2/camera_list.h"
#include "vision/v4l2/v4l2_camera.h"

#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

namespace v4l2 = vision::v4l2;

constexpr std::string_view v4l2_prefix = "v4l2:";

[[noreturn]] void refuse_camera(const SessionOptions& options, std::string_view why) {
    std::vector<std::string> allowed{"sim"};
    for (const v4l2::ListedCamera& camera : v4l2::list_cameras())
        allowed.push_back(std::string(v4l2_prefix) + camera.node.string());
    throw InputError(
        fmt::format("--camera {}: {}; allowed: {}", options.camera, why, fmt::join(allowed, ", ")));
}

v4l2::CaptureSettings settings_of(const SessionOptions& options, const CameraParameters& camera) {
    const CaptureKeys keys = load_capture_keys(options.rig_file);
    v4l2::CaptureSettings settings;
    settings.width_px = camera.geometry.width_px;
    settings.height_px = camera.geometry.height_px;
    settings.frame_rate_hz = camera.frame_rate_hz;
    settings.exposure_s = camera.exposure_s;
    settings.latency_s = camera.latency_s;
    settings.pixels = keys.format;
    settings.gain = keys.gain;
    settings.focus = keys.focus;
    settings.reconnect_s = options.camera_reconnect_s;
    return settings;
}

}  // namespace

bool camera_is_simulated(const SessionOptions& options) {
    return options.camera == "sim";
}

std::shared_ptr<vision::Camera> open_camera(const SessionOptions& options, const CameraParameters& camera) {
    if (options.camera.starts_with("images:"))
        refuse_camera(options, "images on disk cannot guide a motion; inspect measures them again");
    if (!options.camera.starts_with(v4l2_prefix)) refuse_camera(options, "no such camera");
    const std::filesystem::path node = options.camera.substr(v4l2_prefix.size());
    std::error_code error;
    if (!std::filesystem::is_character_file(node, error)) refuse_camera(options, "no such device");
    const v4l2::CaptureSettings settings = settings_of(options, camera);
    try {
        auto opened = std::make_shared<v4l2::V4l2Camera>(node, settings);
        for (const std::string& note : opened->notes()) spdlog::info("{}: {}", node.string(), note);
        return opened;
    } catch (const InputError& wrong) {
        throw InputError(fmt::format("{}: {}", options.rig_file.string(), wrong.what()));
    }
}

std::string text_of(const vision::FrameCounts& counts) {
    std::string text = fmt::format("{} frames used", counts.handed_out);
    const auto add = [&](std::uint64_t count, std::string_view what) {
        if (count > 0) text += fmt::format(", {} {}", count, what);
    };
    add(counts.skipped, "skipped for newer ones");
    add(counts.lost, "lost by the camera");
    add(counts.damaged, "damaged");
    add(counts.unstamped, "without a time stamp");
    add(counts.reconnects, counts.reconnects == 1 ? "reconnection" : "reconnections");
    return text;
}

}  // namespace fidservo
