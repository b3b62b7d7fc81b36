// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A command that acts late: within a tick, first what was commanded before, then what is commanded since.
#include <array>
#include <vector>

namespace fidservo::reference {

/// A command and for how long of the tick it acts.
struct HeldCommand {
    double volts;
    double length_s;
};

/// The commands of the past ticks that still act, oldest first; before the start they were zero.
struct DelayLine {
    std::vector<double> past_V;
};

DelayLine idle_line(double delay_s, double tick_s);

/// Takes the command of a new tick. @return what acts within this tick, in order
std::array<HeldCommand, 2> command(DelayLine& line, double delay_s, double tick_s, double volts);

}  // namespace fidservo::reference
