// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What identification of the macro stage takes from a recording: stretches of commands and positions without
// a gap, away from the ends of travel.
#include "core/recording.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo::calib {

/// Row k: the position sampled at tick k, the command applied from then on.
struct MacroTrace {
    std::string name;
    double tick_s = 0.0;
    std::vector<double> command_V;
    std::vector<double> position_mm;  ///< count times resolution where the encoder counts
    std::size_t recording = 0;        ///< which one; traces of one recording share it
};

/// The stretches of a recording that have a command and a position in every row, at its tick.
/// @param resolution_mm  of the encoder, for recordings in counts
/// @param index  the recording's, as the traces will hold it
std::vector<MacroTrace> macro_traces(const Recording& recording, double resolution_mm, std::size_t index = 0);

/// Where the carriage can be: the ends of travel in the encoder's frame, which may be infinite.
struct Travel {
    double low_mm;
    double high_mm;
};

/// Which ticks of a trace a free carriage explains. Left out is where it ran into an end stop, until it
/// leaves it again: within two counts of an end of travel, or stopped dead from more than a count a tick, for
/// 20 ms or longer, under no less a command than had moved it (an end stop elsewhere, or an encoder of
/// unknown origin).
std::vector<bool> free_ticks(const MacroTrace& trace, double resolution_mm, const Travel& travel);

/// A piece of a trace with a state of its own at its start.
struct MacroWindow {
    std::span<const double> command_V;
    std::span<const double> position_mm;
    double tick_s;
    std::size_t recording = 0;
    double start_s = 0.0;  ///< since the trace's first tick
};

/// Cuts the free ticks into windows of about `window_s`; pieces shorter than `least_s` are left out.
std::vector<MacroWindow> cut_windows(const MacroTrace& trace, const std::vector<bool>& free, double window_s,
                                     double least_s);

}  // namespace fidservo::calib
