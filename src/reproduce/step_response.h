// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The response of a controlled stage to a step of its set point.
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::reproduce {

struct StepResponse {
    double from = 0.0, to = 0.0;  ///< old and new set point, in the position's unit
    double settling_s = 0.0;   ///< from the step until the position stays within the band; infinite if never
    double overshoot = 0.0;    ///< largest excursion beyond the new set point, in the position's unit; >= 0
    double final_error = 0.0;  ///< mean of position - set point over the tail
    double tail_rms = 0.0;     ///< r.m.s. of position - set point over the tail
    /// peak-to-peak of the position over the tail: twice the amplitude of a limit cycle.
    double tail_peak_to_peak = 0.0;
    double dead_s = 0.0;  ///< from the step until the position has moved by `band` for the first time
};

/// @param position  in the rows from the step to the next one
/// @param band      half width within which a position counts as settled, > 0
/// @param tail_s    duration of the tail, at the end
StepResponse step_response(std::span<const double> position, double from, double to, double band,
                           double tail_s, double tick_s);

/// A constant set point, and the rows in which it is held.
struct HeldSetpoint {
    std::size_t begin, end;  ///< rows, end excluded
    double value;
};

/// The stretches of a piecewise constant set point, in order; rows without one are left out.
std::vector<HeldSetpoint> held_setpoints(std::span<const double> setpoint);

}  // namespace fidservo::reproduce
