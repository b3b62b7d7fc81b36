// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The data from a recording for the identification of the macro stage: gapless stretches of commands and
// positions away from the ends of travel.
#include "core/recording.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo::calib {

/// A gapless stretch. Row k has the position sampled at tick k and the command applied from then on.
struct MacroTrace {
    std::string name;
    double tick_s = 0.0;
    std::vector<double> command_V;
    std::vector<double> position_mm;  ///< count times resolution, if the recording has counts
    std::size_t recording = 0;        ///< index of the recording; traces of one recording share it
};

/// The stretches of a recording that have a command and a position in every row, at its tick.
/// @param resolution_mm  of the encoder, for recordings in counts
/// @param index  the recording's, as the traces will hold it
std::vector<MacroTrace> macro_traces(const Recording& recording, double resolution_mm, std::size_t index = 0);

/// The ends of travel in the encoder's frame; they may be infinite.
struct Travel {
    double low_mm;
    double high_mm;
};

/// Which ticks of a trace the model of a free carriage applies to. Excluded are times at an end stop, until
/// the carriage leaves it: the carriage is within two counts of an end of travel, or it stopped abruptly from
/// more than a count per tick and stands for 20 ms or longer although the command is at least as large as
/// before (an end stop elsewhere, or an encoder of unknown origin).
std::vector<bool> free_ticks(const MacroTrace& trace, double resolution_mm, const Travel& travel);

/// A piece of a trace, with an initial state of its own.
struct MacroWindow {
    std::span<const double> command_V;
    std::span<const double> position_mm;
    double tick_s;
    std::size_t recording = 0;
    double start_s = 0.0;  ///< time since the trace's first tick
};

/// Cuts the free ticks into windows of about `window_s`; pieces shorter than `least_s` are left out.
std::vector<MacroWindow> cut_windows(const MacroTrace& trace, const std::vector<bool>& free, double window_s,
                                     double least_s);

}  // namespace fidservo::calib
