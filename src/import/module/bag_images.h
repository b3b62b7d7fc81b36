// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Camera messages of ROS 2.
#include "src/import/log.h"
#include "src/import/module/cdr.h"

#include <string>
#include <string_view>

namespace fidservo::imports {

/// The image of a sensor_msgs/Image message in grey. Encodings: mono8, mono16, 8UC1, 16UC1, rgb8, bgr8,
/// rgba8, bgra8 and bayer_*8; colour is converted to luma, 16 bits are kept. Throws CdrError.
LoggedFrame frame_of_image(std::string_view message);

/// Whether sensor_msgs/Image states an encoding of 16 bits. Throws CdrError.
bool is_deep_image(std::string_view message);

/// The PNG or JPEG file in a sensor_msgs/CompressedImage message, unchanged. Throws CdrError.
LoggedFrame frame_of_compressed(std::string_view message);

/// A sensor_msgs/CameraInfo message as YAML that load_camera_info() reads. Throws CdrError.
std::string text_of_camera_info(std::string_view message);

}  // namespace fidservo::imports
