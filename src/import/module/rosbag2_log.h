// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bags of ROS 2 in SQLite's format.
#include "src/import/log.h"

namespace fidservo::imports {

/// Of the topics of std_msgs' numbers TOPIC; of sensor_msgs/JointState TOPIC/position[JOINT], velocity and
/// effort; of Image and CompressedImage cameras; of CameraInfo texts. Times are the headers' stamps,
/// TOPIC/stamp, or where there is none those at which the bag received the messages, TOPIC/received. Messages
/// are put in the order of their times.
LogOrFault read_rosbag2_file(const char* file);

}  // namespace fidservo::imports
