// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// In which state a recording finds the wire.
#include "gap/links/platform_link.h"

#include <span>

namespace fidservo::gap {

/// The stage at a run's first row, as far as a hypothesis can tell: cold; or unmoved, at the temperature from
/// which it predicts best what follows; or heated from cold to where the first readings are.
plant::MicroStageState first_state(const PlatformModel& model, const PlatformRun& run);

/// What the rig file's stage can tell of the wire at the start of a run. A rig that differs from its file is
/// predicted badly from any temperature, so that a wire is cold only if that shows: what follows is at the
/// floor, or readings stand still that a warm wire, cooling, would change. It is warm if what follows is
/// predicted far better from a higher temperature at which the first readings can be what they are, or if
/// nothing else explains that these exceed a cold wire's.
/// @param nominal  the rig file's stage
/// @param zero_lsb  what the sensor reads more than by the rig file
WireStart wire_start(const PlatformModel& nominal, const PlatformRun& run, double zero_lsb);

/// What the readings with which recordings begin exceed a cold wire's by where they stand still though
/// nothing heats the wire, as only a cold wire's do: their median over the recordings; 0 where none begins
/// so.
double zero_of_sensor_lsb(const PlatformModel& nominal, std::span<const PlatformRun* const> runs);

/// One row of a run; a platform that feels the carriage needs its path.
void step(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage, std::size_t row,
          plant::MicroStageState& state);

/// Moves wire and platform to another temperature; no turn is remembered that never was.
void slide(const plant::MicroStage& stage, plant::MicroStageState& state, double by_degC);

}  // namespace fidservo::gap
