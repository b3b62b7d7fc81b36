// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bags of ROS 2 in SQLite's format.
#include "src/import/log.h"

#include <filesystem>
#include <vector>

namespace fidservo::imports {

/// Reads the files of one bag as one log. Of the topics of std_msgs' numbers TOPIC; of sensor_msgs/JointState
/// TOPIC/position[JOINT], velocity and effort, each with the messages that name the joint; of Image and
/// CompressedImage cameras; of CameraInfo texts. Times are the headers' stamps, TOPIC/stamp, or where there
/// is none those at which the bag received the messages, TOPIC/received, which are there in any case; of a
/// joint that some messages do not name TOPIC/stamp/position[JOINT]. Messages are put in the order of their
/// times.
/// @param files  one at least, in their order; a file that zstd compressed is decompressed
/// @param is_interrupted  asked many times a second; once it gives true, so does a fault end the reading
LogOrFault read_rosbag2_files(const std::vector<std::filesystem::path>& files, bool (*is_interrupted)());

}  // namespace fidservo::imports
