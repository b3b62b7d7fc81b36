#pragma once
// In which state a recording finds the wire.
#include "gap/platform_link.h"

namespace fidservo::gap {

/// A stage whose wire was heated from cold to where the first readings are; cold if they say so, or if what
/// follows does: a sensor that reads high at a cold wire goes on to, a warm wire cools.
plant::MicroStageState first_state(const PlatformModel& model, const PlatformRun& run);

/// Whether a wire is warm at the start of a recording, so that neither its temperature nor its memory is
/// known: its readings exceed a cold wire's by more than a sensor's zero can be off, or exceed them and move
/// while a cold wire's would stand still; or what follows is predicted far better from a higher temperature,
/// at which the first readings can be what they are.
/// @param nominal  the rig file's stage
bool starts_warm(const PlatformModel& nominal, const PlatformRun& run);

/// One row of a run; a platform that feels the carriage needs its path.
void step(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage, std::size_t row,
          plant::MicroStageState& state);

/// Moves wire and platform to another temperature; no turn is remembered that never was.
void slide(const plant::MicroStage& stage, plant::MicroStageState& state, double by_degC);

}  // namespace fidservo::gap
