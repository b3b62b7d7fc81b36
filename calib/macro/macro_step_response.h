// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The identification procedure of the published stage, step by step, as its paper describes it: the threshold
// from rising DC steps, the discrete transfer function of eq. (6) from one compensated step, the modified
// dead zone of eq. (7) from steps of several amplitudes. It needs recordings of exactly these experiments;
// identify_macro (macro_identification.h) takes any recordings. Both agree.
#include "calib/macro/macro_identification.h"
#include "core/result.h"

#include <span>

namespace fidservo::calib {

/// Threshold from commands that rise in steps: half way between the largest command at which the carriage
/// stayed at rest and the smallest at which it moved, with the standard deviation of a uniform distribution
/// between them.
/// @param side  +1 for commands to the right, -1 to the left
/// @return fails with Reason::not_identifiable if no command moved the carriage or no smaller command was
/// tried
Result<MacroEstimate> threshold_from_rising_steps(const MacroTrace& trace, double resolution_mm, double side);

/// Y/V = b / ((z - 1)(z - p)), eq. (6), with Y in counts and V the effective voltage.
struct StepModel {
    double numerator_count_per_V;  ///< b
    double pole;                   ///< p, per tick
    double gain_mm_per_s_per_V;    ///< K = b resolution / ((1 - p) T)
    double time_constant_s;        ///< tau = -T / ln p
    int iterations;
};

/// Modified least squares on one step from rest. As the integrator is known, eq. (6) is summed once:
///
///     y[k] - y[0] = p (y[k-1] - y[0]) + b sum_{i<k} V'[i] + c,     V'[k] = beta V[k] + (1 - beta) V[k-1]
///
/// The sum does not amplify the counts' rounding, as differences would, but the regressor y[k-1] contains the
/// rounding, too, which would bias ordinary least squares. Therefore instrumental variables without rounding
/// are used: the model's response with p and b of the previous iteration, until these converge (Young's
/// refined instrumental variable, Automatica 17(6), 1981). V' distributes the held command over two samples
/// as the exact discretisation of the continuous axis does, beta = (1 - (1 - p) tau/T) / (1 - p). Eq. (6) has
/// a single sample instead, which taken literally would change tau by half a tick.
/// @param volts  effective voltage (the compensated command) at each tick, 0 before the step
/// @return fails with Reason::not_identifiable if the trace has less than 20 ticks of motion or the iteration
/// does not converge to a pole in (0, 1)
Result<StepModel> step_model(const MacroTrace& trace, std::span<const double> volts, double resolution_mm);

/// One step: its command and its terminal speed in mm/s.
struct SteadySpeed {
    double command_V;
    double speed_mm_per_s;
};

/// Eq. (7) from steps of several amplitudes: the straight line through their terminal speeds, K (a0 + delta
/// (|u| - threshold)), with K the speed at `unit_V`.
struct DeadZoneModel {
    double gain_mm_per_s_per_V;
    double offset_V;  ///< a0
    double slope;     ///< delta
};

/// Fails with Reason::not_identifiable if the amplitudes span less than a twentieth of their mean.
Result<DeadZoneModel> dead_zone_from_amplitudes(std::span<const SteadySpeed> speeds, double threshold_V,
                                                double unit_V);

}  // namespace fidservo::calib
