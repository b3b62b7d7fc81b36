// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/recording.h"
#include "reference/departures.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

/// As `simulate`, but on the independent model of the rig (reference/): for tests against physics that the
/// diagnosis does not share.
/// @param departures  deviations of the rig that its file does not state
/// @param substeps  integration steps per tick; the independent model's default where it is not given
/// @param way_mm  receives the camera's true position (macro + micro) at every tick, if given
Recording simulate_reference(const Rig& rig, const reference::Departures& departures,
                             const Experiment& experiment, const std::string& name, std::uint64_t seed,
                             std::vector<double>* way_mm = nullptr, std::optional<int> substeps = {});

}  // namespace fidservo
