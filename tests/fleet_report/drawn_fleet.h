// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Simulated results of a fleet whose units have known effects: parameters are drawn, nothing is recorded.
#include "src/fleet/report/result.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// An effect that units have to different degrees.
struct DrawnEffect {
    std::string effect, block, parameter, unit;
    double vanishing;  ///< vanishing value of its one size
    double per_floor;  ///< size that causes a gap of one floor
};

/// How a fleet is drawn.
struct DrawnFleet {
    std::uint64_t seed = 1;
    std::size_t units = 50, weeks = 8;
    double std_floors = 0.1;       ///< stated standard error of a diagnosis
    double scatter_floors = 0.15;  ///< additional scatter from week to week
    double spread_floors = 0.3;    ///< from unit to unit
    /// The true deviation from the rig file, floors: by effect, unit and week.
    std::function<double(std::size_t effect, std::size_t unit, std::size_t week)> truth =
        [](std::size_t, std::size_t, std::size_t) { return 0.0; };
    std::size_t batches = 5;  ///< number of batches (label `batch`), to which units are assigned in turn
};

/// The effects of drawn fleets.
const std::vector<DrawnEffect>& drawn_effects();

/// The results of weekly diagnoses. Effects below 1.1 floors are not named.
std::vector<FleetResult> draw(const DrawnFleet& fleet);

/// The text of a result's file.
std::string file_text(const FleetResult& result);

}  // namespace fidservo::fleet
