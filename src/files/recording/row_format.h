// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The text format of recordings.
#include "core/camera/camera_parameters.h"
#include "core/recording.h"

#include <string>

namespace fidservo {

/// The corners' columns in a file of detections: their places only, or their covariances, too.
enum class CornerColumns { places, places_and_covariances };

std::string stage_header(const StageColumns& columns);
std::string detections_header(CornerColumns columns = CornerColumns::places);
/// The column titles of the corners.
std::string corners_header(CornerColumns columns);
std::string frames_header();

/// Appends one line with its line end. A value that is not in force is an empty field; zero has no sign.
void append_row(std::string& text, const StageRow& row, const StageColumns& columns);
void append_detection(std::string& text, const TagDetection& detection,
                      CornerColumns columns = CornerColumns::places);
/// Appends the corners only, with a comma before each field.
void append_corners(std::string& text, const TagDetection& detection, CornerColumns columns);
void append_frame(std::string& text, const FrameName& frame);

/// Rounds the numbers of a recording in memory to those that are read where append_row and append_detection
/// have written it.
void round_as_written(Recording& recording);

/// cam0/sensor.yaml.
std::string sensor_yaml(const CameraParameters& camera);

}  // namespace fidservo
