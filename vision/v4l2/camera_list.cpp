// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/camera_list.h"

#include "vision/v4l2/capability.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace fidservo::vision::v4l2 {

namespace {

namespace fs = std::filesystem;

std::optional<int> number_of(std::string_view node) {
    constexpr std::string_view prefix = "video";
    if (!node.starts_with(prefix)) return std::nullopt;
    node.remove_prefix(prefix.size());
    int number = 0;
    const auto [end, error] = std::from_chars(node.data(), node.data() + node.size(), number);
    if (error != std::errc() || end != node.data() + node.size()) return std::nullopt;
    return number;
}

std::vector<int> video_numbers() {
    std::vector<int> numbers;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/sys/class/video4linux", error))
        if (const auto number = number_of(entry.path().filename().string())) numbers.push_back(*number);
    std::ranges::sort(numbers);
    return numbers;
}

/// Nothing for nodes that do not capture.
std::optional<ListedCamera> ask(const fs::path& node) {
    ListedCamera camera;
    camera.node = node;
    camera.by_id = by_id_of(node);
    const auto device = Device::open(node);
    if (!device) {
        camera.trouble = device.error().text;
        return camera;
    }
    const auto capability = capability_of(*device);
    if (!capability) {
        camera.trouble = capability.error().text;
        return camera;
    }
    if (!capability->captures) return std::nullopt;
    camera.driver = capability->driver;
    camera.card = capability->card;
    camera.bus = capability->bus;
    camera.formats = offered_formats(*device);
    camera.controls = list_controls(*device);
    return camera;
}

}  // namespace

std::vector<ListedCamera> list_cameras() {
    std::vector<ListedCamera> cameras;
    for (const int number : video_numbers())
        if (auto camera = ask("/dev/video" + std::to_string(number))) cameras.push_back(std::move(*camera));
    return cameras;
}

fs::path by_id_of(const fs::path& node) {
    // Not equivalent(), which does not compare device nodes.
    std::error_code error;
    const fs::path target = fs::canonical(node, error);
    for (const auto& link : fs::directory_iterator("/dev/v4l/by-id", error))
        if (!target.empty() && fs::canonical(link.path(), error) == target) return link.path();
    return {};
}

}  // namespace fidservo::vision::v4l2
