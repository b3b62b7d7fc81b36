#pragma once
// In which state a recording finds the wire.
#include "gap/platform_link.h"

namespace fidservo::gap {

/// A stage whose wire was heated from cold to where the first readings are; cold if they say so, or if what
/// follows does: a sensor that reads high at a cold wire goes on to, a warm wire cools.
plant::MicroStageState first_state(const PlatformModel& model, const PlatformRun& run);

/// Whether a wire is warm at the start of a recording: by more than a sensor's zero can be off, or because
/// what follows scatters far less about a wire that cools than about a cold one whose sensor reads high.
/// @param nominal  the rig file's stage
bool starts_warm(const PlatformModel& nominal, const PlatformRun& run);

/// One row of a run; a platform that feels the carriage needs its path.
void step(const PlatformModel& model, const PlatformRun& run, const CarriagePath* carriage, std::size_t row,
          plant::MicroStageState& state);

/// Moves wire and platform to another temperature; no turn is remembered that never was.
void slide(const plant::MicroStage& stage, plant::MicroStageState& state, double by_degC);

}  // namespace fidservo::gap
