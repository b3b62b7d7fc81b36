// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/delay_line.h"

#include <algorithm>
#include <cmath>

namespace fidservo::reference {

DelayLine idle_line(double delay_s, double tick_s) {
    return {std::vector<double>(static_cast<std::size_t>(std::floor(delay_s / tick_s)) + 2, 0.0)};
}

std::array<HeldCommand, 2> command(DelayLine& line, double delay_s, double tick_s, double volts) {
    std::rotate(line.past_V.begin(), line.past_V.begin() + 1, line.past_V.end());
    line.past_V.back() = volts;
    const double into_tick_s = delay_s - tick_s * std::floor(delay_s / tick_s);
    return {{{line.past_V[0], into_tick_s}, {line.past_V[1], tick_s - into_tick_s}}};
}

}  // namespace fidservo::reference
