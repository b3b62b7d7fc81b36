// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The state of the wire when a recording begins.
#include "gap/links/platform_link.h"

#include <span>

namespace fidservo::gap {

/// The stage at a run's first row under a hypothesis: cold, unmoved at the temperature from which the
/// following readings are predicted best, or warm, heated from cold until it gives the first readings
/// (WireStart).
plant::MicroStageState first_state(const PlatformModel& model, const PlatformRun& run);

/// What the rig file's model can tell of the wire at the start of a run. A rig that differs from its file is
/// predicted badly from any temperature, so that a wire counts as cold only if something shows that: the
/// following readings are at the floor, or they are constant where those of a warm wire would change as it
/// cools. It counts as warm if the following readings are predicted far better from a higher temperature that
/// is compatible with the first ones, or if nothing else explains why these exceed a cold wire's. Otherwise
/// it counts as unmoved.
/// @param nominal  the rig file's stage
/// @param zero_lsb  by how much the sensor reads more than by the rig file
WireStart wire_start(const PlatformModel& nominal, const PlatformRun& run, double zero_lsb);

/// By how much the sensor reads more than by the rig file: the median, over recordings, of what the first
/// readings exceed a cold wire's by, where they are constant although nothing heats the wire, as only a cold
/// wire's are; 0 where there is no such recording.
double zero_of_sensor_lsb(const PlatformModel& nominal, std::span<const PlatformRun* const> runs);

/// Advances a stage by one row of a run.
/// @param carriage  needed for a platform that the carriage's motion affects; may be null otherwise
void step(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage, std::size_t row,
          plant::MicroStageState& state);

/// Changes the temperature of the wire, and the platform's position with it. The wire's memory stores no
/// reversal that never happened.
void slide(const plant::MicroStage& stage, plant::MicroStageState& state, double by_degC);

}  // namespace fidservo::gap
