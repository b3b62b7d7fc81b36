// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bags of ROS 2 in SQLite's format.
#include "src/import/log.h"

#include <filesystem>
#include <vector>

namespace fidservo::imports {

/// Reads the files of one bag as one log. A topic with numbers of std_msgs becomes the signal TOPIC; one of
/// sensor_msgs/JointState the signals TOPIC/position[JOINT], velocity and effort, each from the messages that
/// contain the joint; Image and CompressedImage become cameras, CameraInfo texts. Times are the stamps of the
/// headers (signal TOPIC/stamp) or, without stamps, the times of reception (TOPIC/received, which always
/// exists). A joint that is missing from some messages has its own times, TOPIC/stamp/position[JOINT].
/// Messages are sorted by time.
/// @param files  at least one, in order; may be compressed by zstd
/// @param is_interrupted  called many times a second; once it returns true, reading ends with an error
LogOrFault read_rosbag2_files(const std::vector<std::filesystem::path>& files, bool (*is_interrupted)());

}  // namespace fidservo::imports
