// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A delayed command. Within a tick there may be two pieces: first the command before, then the one after.
#include <array>
#include <vector>

namespace fidservo::reference {

/// A command and the part of the tick for which it acts.
struct HeldCommand {
    double volts;
    double length_s;
};

/// The commands of past ticks that are still to act, oldest first; before the start they were zero.
struct DelayLine {
    std::vector<double> past_V;
};

DelayLine idle_line(double delay_s, double tick_s);

/// Takes the command of a new tick.
/// @return the commands that act within this tick, in order
std::array<HeldCommand, 2> command(DelayLine& line, double delay_s, double tick_s, double volts);

}  // namespace fidservo::reference
