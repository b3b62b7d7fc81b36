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

/// Threshold from commands that rise in steps: half way between the largest command under which the carriage
/// stayed and the smallest under which it left, with the standard error of a uniform distribution between
/// them.
/// @param side  +1 for commands to the right, -1 to the left Fails with Reason::not_identifiable if nothing
/// moved it or no smaller command was tried.
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
/// The sum does not amplify the counts' rounding, as differences would, but the rounding is also in the
/// regressor y[k-1] and would bias plain least squares. So instrumental variables are used that are free of
/// it: the model's own response with p and b of the iteration before, until these converge (Young's refined
/// instrumental variable, Automatica 17(6), 1981). V' distributes the held command over the two samples as
/// the continuous-time axis does, beta = (1 - (1 - p) tau/T) / (1 - p) of the exact numerator: eq. (6) lumps
/// it into one sample, which taken literally would put half a tick into tau.
/// @param volts  effective voltage at each tick, 0 before the step: the compensated command Fails with
/// Reason::not_identifiable if the trace has less than 20 ticks of motion or the iteration does not converge
/// to a pole in (0, 1).
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
