// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the micro command to the Hall reading: a hypothesis's wire, platform and sensor along a recording.
//
// One pass from the start of the recording carries temperature, hysteresis memory, swing and drift. Before
// each window the temperature is corrected by the readings of the 100 ms before it, as a Kalman filter would
// (Maybeck, Stochastic Models, Estimation, and Control 1, 1979, ch. 5): with h the change of the prediction
// per degree and r the reading minus the prediction,
//
//     dT = (sum h r / floor^2) / (1 / std^2 + sum h^2 / floor^2)
//
// at most three times std, what the carried temperature is trusted to. Where the wire does not move with its
// temperature nothing is corrected. The correction slides the end of the branch on which the wire is: no turn
// is remembered that never was.
#include "core/micro_parameters.h"
#include "core/recording.h"
#include "gap/budget.h"
#include "gap/evidence/hall_range.h"
#include "gap/evidence/windows.h"
#include "gap/links/carriage_path.h"
#include "plant/stage_plant.h"

#include <memory>
#include <vector>

namespace fidservo::gap {

/// What is known of a wire when its recording begins.
enum class WireStart {
    cold,     ///< at the room's temperature
    unmoved,  ///< it remembers nothing, but may be warmer than the room
    warm,     ///< neither its temperature nor its memory is known
};

/// What a recording says of the platform, row by row.
struct PlatformRun {
    double tick_s = 0.0;
    std::shared_ptr<const Budget> budget;  ///< asked by what runs along the recording; may be empty
    std::vector<double> command_V;         ///< what was last commanded where a row has none
    std::vector<double> macro_command_V;   ///< likewise
    std::vector<double> hall_adc;          ///< NaN where missing, or at an end of the range
    std::vector<int> ticks;                ///< to the next row
    std::vector<WindowRows> windows;       ///< by time
    /// Of each window, whether the platform is beside its prediction by a constant that the rows before it
    /// tell (gap/links/wire_memory.h); empty: none is.
    std::vector<bool> is_beside;
    WireStart start = WireStart::cold;  ///< gap/links/wire_start.h
    double floor_lsb = 0.0;
};

/// After a pause in the rows or commands of more than 0.1 s, or 10 ms where the command is another one then,
/// nobody knows what a warm wire remembers: windows begin again when it has been cold for five cooling time
/// constants.
PlatformRun platform_run(const Recording& recording, const MicroParameters& micro, const HallRange& range,
                         double floor_lsb);

struct PlatformModel {
    plant::MicroStage stage;
    plant::MacroAxisParameters axis;
};

/// Demands a micro stage.
PlatformModel platform_model(const plant::PlantParameters& parameters);

struct PlatformPrediction {
    std::vector<double> reading_lsb;       ///< mean reading for the rows of all windows; NaN elsewhere
    std::vector<double> path_lsb;          ///< for all rows, each window faded into the next
    std::vector<double> temperature_degC;  ///< of the wire, likewise, not faded
};

/// @param carriage  none where the platform does not feel it
PlatformPrediction predicted_readings(const PlatformModel& model, const PlatformRun& run,
                                      const CarriagePath* carriage);

}  // namespace fidservo::gap
