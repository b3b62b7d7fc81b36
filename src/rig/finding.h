// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Implausible values in a valid rig file. Each kind of number has a file of its own; the origin of each limit
// is stated beside it.
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

/// An implausible value.
struct Finding {
    std::string key;    ///< in the rig file
    std::string value;  ///< its value
    std::string why;    ///< the consequence
    std::string usual;  ///< the expected value
};

/// Largest plausible step of a position reading, as a fraction of the travel.
inline constexpr double coarsest_step_share = 0.01;

/// All of those below.
std::vector<Finding> findings_of(const Rig& rig);

/// Tick, travel, encoder, dynamics and friction of the axis.
std::vector<Finding> axis_findings(const Rig& rig);
/// Heater, wire and Hall sensor.
std::vector<Finding> micro_findings(const Rig& rig);
/// Controllers: the poles of their linear loops with the file's own model, and their friction compensation.
std::vector<Finding> loop_findings(const Rig& rig);
/// Camera and fiducials: scale, and visible fiducials over the travel.
std::vector<Finding> sight_findings(const Rig& rig);

}  // namespace fidservo
