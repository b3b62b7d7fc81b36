// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/capture_keys.h"

#include <limits>

namespace fidservo {

namespace {

constexpr int most = std::numeric_limits<int>::max();

}  // namespace

CaptureKeys read_capture_keys(const YamlValue& map) {
    map.allow_only({"format", "gain", "focus"});
    CaptureKeys keys;
    if (const auto format = map.find("format"))
        keys.format =
            vision::v4l2::pixel_formats[format->one_of({"GREY", "Y16", "Y12", "Y10", "YUYV", "MJPEG"})];
    if (const auto gain = map.find("gain")) keys.gain = gain->integer(-most, most);
    if (const auto focus = map.find("focus")) keys.focus = focus->integer(-most, most);
    return keys;
}

CaptureKeys load_capture_keys(const std::filesystem::path& rig_file) {
    const auto camera = YamlValue::load(rig_file).find("camera");
    const auto capture = camera ? camera->find("capture") : std::nullopt;
    return capture ? read_capture_keys(*capture) : CaptureKeys{};
}

}  // namespace fidservo
