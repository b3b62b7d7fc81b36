// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera section of a rig file: its keys and their allowed values.
#include "core/camera/camera_parameters.h"
#include "src/files/text/yaml_reader.h"

#include <array>

namespace fidservo {

inline constexpr int least_image_px = 16;
inline constexpr int most_image_px = 20'000;

/// Keys of `camera` that a ROS file can provide instead.
inline constexpr std::array intrinsic_camera_keys{
    "width_px", "height_px", "focal_px", "focal_ratio", "principal_point_px", "lens", "distortion"};

/// A rig file's `camera`: its own numbers, or those of a ROS file (camera_info.h) where it names one. Throws
/// InputError.
CameraParameters read_rig_camera(const YamlValue& map);

/// Throws InputError unless a pixel is nearly square.
/// @param value  the value that the error names
void check_focal_ratio(const YamlValue& value, double focal_ratio);

/// Throws InputError on a focal length at which a camera without distortion would see more than 170 degrees
/// along the image's longer side: it is given in mm or m. Fisheye lenses have longer ones for what they see.
/// @param value  the value that the error names
void check_focal_length(const YamlValue& value, double focal_px, int longer_side_px);

}  // namespace fidservo
