// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recordings as text, byte for byte.
#include "core/camera/camera_parameters.h"
#include "core/recording.h"

#include <string>

namespace fidservo {

/// What a file says of detections: their corners alone, or also how well they are known.
enum class CornerColumns { places, places_and_covariances };

std::string stage_header(const StageColumns& columns);
std::string detections_header(CornerColumns columns = CornerColumns::places);
/// The titles of the corners' columns alone.
std::string corners_header(CornerColumns columns);
std::string frames_header();

/// Each appends one line with its end. A value that is not in force is an empty field; zero has no sign.
void append_row(std::string& text, const StageRow& row, const StageColumns& columns);
void append_detection(std::string& text, const TagDetection& detection,
                      CornerColumns columns = CornerColumns::places);
/// The corners alone, with a comma before each field.
void append_corners(std::string& text, const TagDetection& detection, CornerColumns columns);
void append_frame(std::string& text, const FrameName& frame);

/// cam0/sensor.yaml.
std::string sensor_yaml(const CameraParameters& camera);

}  // namespace fidservo
