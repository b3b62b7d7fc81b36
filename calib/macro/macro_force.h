// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The error of a macro stage's model relative to the force in a recording: inverse dynamics, the usual
// measure for models of drives (Gautier, Janot, Vandanjon, A new closed-loop output error method for
// parameter identification of robot dynamics, IEEE TCST 21(2), 2013).
#include "calib/macro/macro_motion.h"
#include "calib/macro/macro_trace.h"
#include "core/result.h"

#include <span>

namespace fidservo::calib {

/// Relative error of the force, r.m.s. of  KV(u) - C sgn(v) - (tau a + v)  over r.m.s. of  KV(u).
///
/// The contribution of the readings' white noise to the numerator is subtracted (its upper 1 % quantile), so
/// that where noise hides the accelerations no error of the force is reported.
///
/// Position, its second differences, drive and friction pass through the same zero-phase Gaussian low-pass of
/// 5 ms standard deviation, so that the filter cancels. Ticks slower than a twentieth of the fastest are left
/// out: the model does not describe friction at rest. Fails with Reason::not_identifiable if less than 100 ms
/// of motion remains.
Result<double> relative_force_error(std::span<const MacroTrace> traces, const MacroMotion& motion,
                                    double white_noise_mm = 0.0);

}  // namespace fidservo::calib
