// fidservo cameras: the V4L2 devices of this machine.
#include "src/commands/commands.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

struct VideoDevice {
    fs::path device;
    std::string name;
    fs::path by_id;  ///< a path that stays the same across restarts; empty if the system gives none
};

std::string first_line_of(const fs::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    return line;
}

fs::path find_by_id(const fs::path& device) {
    std::error_code error;
    for (const auto& link : fs::directory_iterator("/dev/v4l/by-id", error))
        if (fs::equivalent(link.path(), device, error)) return link.path();
    return {};
}

std::vector<VideoDevice> find_video_devices() {
    std::vector<VideoDevice> devices;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/sys/class/video4linux", error)) {
        const std::string node = entry.path().filename();
        if (!node.starts_with("video")) continue;
        const fs::path device = fs::path("/dev") / node;
        devices.push_back({device, first_line_of(entry.path() / "name"), find_by_id(device)});
    }
    std::sort(devices.begin(), devices.end(),
              [](const VideoDevice& a, const VideoDevice& b) { return a.device < b.device; });
    return devices;
}

int run_cameras() {
    const std::vector<VideoDevice> devices = find_video_devices();
    if (devices.empty()) fmt::print("no camera found\n");
    for (const VideoDevice& camera : devices)
        fmt::print("v4l2:{}  {}{}\n", camera.device.string(), camera.name,
                   camera.by_id.empty() ? "" : "  " + camera.by_id.string());
    return exit_done;
}

}  // namespace

void add_cameras(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("cameras", "List the cameras of this machine (V4L2)");
    add_example(*command, "fidservo cameras");
    command->callback([&exit_code] { exit_code = run_cameras(); });
}

}  // namespace fidservo
