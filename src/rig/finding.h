// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What looks wrong in a rig file that loads. Each kind of number has its own file; where a limit comes from
// is said beside it.
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

/// One thing that looks wrong.
struct Finding {
    std::string key;    ///< in the rig file
    std::string value;  ///< what stands there
    std::string why;    ///< what follows from it
    std::string usual;  ///< what would be expected instead
};

/// Of a travel: what a step of the reading may be at most for the place to be known by it.
inline constexpr double coarsest_step_share = 0.01;

/// All of those below.
std::vector<Finding> findings_of(const Rig& rig);

/// Tick, travel, encoder, dynamics and friction of the axis.
std::vector<Finding> axis_findings(const Rig& rig);
/// Heater, wire and Hall sensor.
std::vector<Finding> micro_findings(const Rig& rig);
/// Controllers: their linear loops' poles on the file's own model, and what they take friction to be.
std::vector<Finding> loop_findings(const Rig& rig);
/// Camera and fiducials: scale, and what is seen over the travel.
std::vector<Finding> sight_findings(const Rig& rig);

}  // namespace fidservo
