// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the micro command to the Hall reading: wire, platform and sensor of a hypothesis along a recording.
//
// One simulation from the start of the recording gives temperature, hysteresis memory, swing of the platform
// and drift of the sensor. Before each window the temperature is corrected by the readings of the 100 ms
// before it, as a Kalman filter would (Maybeck, Stochastic Models, Estimation, and Control 1, 1979, ch. 5):
// with h the derivative of the prediction with respect to temperature, r the reading minus the prediction,
// and std the standard deviation of the simulated temperature,
//
//     dT = (sum h r / floor^2) / (1 / std^2 + sum h^2 / floor^2)
//
// limited to three times std. Where the contraction does not depend on the temperature, h = 0, nothing is
// corrected. A correction moves the end of the present hysteresis branch; it does not add a reversal to the
// memory.
#include "core/micro_parameters.h"
#include "core/recording.h"
#include "gap/budget.h"
#include "gap/evidence/hall_range.h"
#include "gap/evidence/windows.h"
#include "gap/links/carriage_path.h"
#include "plant/stage_plant.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace fidservo::gap {

/// What is known of a wire when its recording begins.
enum class WireStart {
    cold,     ///< at the room's temperature
    unmoved,  ///< not yet contracted (its hysteresis memory is empty), but possibly warmer than the room
    warm,     ///< neither its temperature nor its hysteresis memory is known
};

/// The platform's part of a recording, row by row.
struct PlatformRun {
    double tick_s = 0.0;
    std::shared_ptr<const Budget> budget;  ///< checked by what simulates along the recording; may be null
    std::vector<double> command_V;         ///< the last command where a row has none
    std::vector<double> macro_command_V;   ///< the same for the macro stage
    std::vector<double> hall_adc;          ///< NaN where missing, or at an end of the range
    std::vector<int> ticks;                ///< number of ticks to the next row
    std::vector<WindowRows> windows;       ///< sorted by time
    /// For each window, whether the platform is offset from its prediction by an unknown constant, which is
    /// estimated from the rows before the window (gap/links/wire_memory.h). Empty if no window has such an
    /// offset.
    std::vector<bool> is_beside;
    WireStart start = WireStart::cold;  ///< what is known of the wire (gap/links/wire_start.h)
    double floor_lsb = 0.0;
};

/// The hysteresis memory of a warm wire is unknown after rows or commands are missing for more than 0.1 s, or
/// for 10 ms if the command has changed meanwhile. Windows are then left out until the wire has been cold for
/// five cooling time constants.
PlatformRun platform_run(const Recording& recording, const MicroParameters& micro, const HallRange& range,
                         double floor_lsb);

struct PlatformModel {
    plant::MicroStage stage;
    plant::MacroAxisParameters axis;
};

/// Requires a micro stage.
PlatformModel platform_model(const plant::PlantParameters& parameters);

/// The stage with a tick that is a whole fraction of the rig's, for positions within a tick: a wire that
/// begins to transform moves the platform by many micrometres a millisecond.
struct FinerStage {
    plant::MicroStage stage;
    std::size_t parts;  ///< of a tick
};

/// Requires a micro stage. The parts are at most a millisecond long; within a part, linear interpolation is
/// precise enough.
FinerStage finer_stage(const plant::PlantParameters& parameters);

struct PlatformPrediction {
    std::vector<double> reading_lsb;  ///< mean reading in the rows of all windows; NaN elsewhere
    std::vector<double> path_lsb;  ///< in all rows, faded into each window's path over the 100 ms before it
    std::vector<double> temperature_degC;  ///< of the wire in all rows, not faded
    /// How far the reading is above the straight line from each row to the next, at the end of every part of
    /// the tick but the last, LSB. Empty unless a finer stage was given.
    std::vector<double> bends_lsb;
};

/// @param carriage  null where it does not affect the platform
/// @param finer     for `bends_lsb`; null: without
PlatformPrediction predicted_readings(const PlatformModel& model, const PlatformRun& run,
                                      const CarriagePath* carriage, const FinerStage* finer = nullptr);

}  // namespace fidservo::gap
