// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The keys `camera.capture` of a rig file: how the camera is to be set. Only programs that open the camera
// read them.
#include "src/files/text/yaml_reader.h"
#include "vision/v4l2/pixel_format.h"

#include <filesystem>
#include <optional>

namespace fidservo {

struct CaptureKeys {
    std::optional<vision::v4l2::PixelFormat> format;  ///< empty: the best one that the camera offers
    std::optional<int> gain;   ///< in the driver's units, as `fidservo cameras` shows them
    std::optional<int> focus;  ///< in the driver's units, as `fidservo cameras` shows them
};

/// The keys of `camera.capture`. Throws InputError.
CaptureKeys read_capture_keys(const YamlValue& map);

/// Those of a rig file; none where it has none. Throws InputError.
CaptureKeys load_capture_keys(const std::filesystem::path& rig_file);

}  // namespace fidservo
