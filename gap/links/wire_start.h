// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The state of the wire when a recording begins.
#include "gap/links/platform_link.h"

#include <span>

namespace fidservo::gap {

/// The stage at a run's first row under a hypothesis, by PlatformRun::start. cold: at the room's temperature;
/// unmoved: at the temperature from which the following readings are predicted best; warm: heated from cold
/// to the temperature that gives the first readings.
plant::MicroStageState first_state(const PlatformModel& model, const PlatformRun& run);

/// The state of the wire at the start of a run, judged by the rig file's model. A rig that differs from its
/// file is predicted badly from any temperature; therefore a wire counts as cold only on positive evidence:
/// the following readings are predicted to their floor from the room's temperature, or they are constant
/// although those of a warm wire would change as it cools. It counts as warm if the following readings are
/// predicted far better from a higher temperature that is compatible with the first readings, or if nothing
/// else explains why the first readings exceed those of a cold wire. Otherwise it counts as unmoved.
/// @param nominal  the rig file's stage
/// @param zero_lsb  offset of the sensor relative to the rig file
WireStart wire_start(const PlatformModel& nominal, const PlatformRun& run, double zero_lsb);

/// Offset of the Hall sensor relative to the rig file: the median of (first readings - those predicted for a
/// cold wire) over the recordings that begin with a cold wire, which are those whose first readings are
/// constant without heating. 0 if there is no such recording.
double zero_of_sensor_lsb(const PlatformModel& nominal, std::span<const PlatformRun* const> runs);

/// Advances a stage by one row of a run.
/// @param carriage  needed for a platform that the carriage's motion affects; may be null otherwise
void step(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage, std::size_t row,
          plant::MicroStageState& state);

/// Corrects the wire's temperature by `by_degC`, and the platform's position with it, without adding a
/// reversal to the hysteresis memory.
void slide(const plant::MicroStage& stage, plant::MicroStageState& state, double by_degC);

}  // namespace fidservo::gap
