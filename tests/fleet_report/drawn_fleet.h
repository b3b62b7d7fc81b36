// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fleets drawn at the level of parameters: what diagnoses would say of units whose effects are known.
#include "src/fleet/report/result.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// An effect of which units have some.
struct DrawnEffect {
    std::string effect, block, parameter, unit;
    double vanishing;  ///< of its one size
    double per_floor;  ///< what makes a gap of one floor
};

/// How a fleet is drawn.
struct DrawnFleet {
    std::uint64_t seed = 1;
    std::size_t units = 50, weeks = 8;
    double std_floors = 0.1;       ///< of one diagnosis, as it states it
    double scatter_floors = 0.15;  ///< from week to week beyond it
    double spread_floors = 0.3;    ///< from unit to unit
    /// Beyond the rig file, floors: of an effect, a unit, a week.
    std::function<double(std::size_t effect, std::size_t unit, std::size_t week)> truth =
        [](std::size_t, std::size_t, std::size_t) { return 0.0; };
    std::size_t batches = 5;  ///< label `batch`, units in turn
};

/// The effects of drawn fleets.
const std::vector<DrawnEffect>& drawn_effects();

/// Results that such a fleet's diagnoses come to, a week apart. What is below 1.1 floors by itself is not
/// named.
std::vector<FleetResult> draw(const DrawnFleet& fleet);

/// The file of a result.
std::string file_text(const FleetResult& result);

}  // namespace fidservo::fleet
