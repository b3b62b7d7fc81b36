// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far a model of the macro stage is from the force that a recording shows: inverse dynamics, as the
// literature on drives judges models (Gautier, Janot, Vandanjon, A new closed-loop output error method for
// parameter identification of robot dynamics, IEEE TCST 21(2), 2013).
#include "calib/macro/macro_motion.h"
#include "calib/macro/macro_trace.h"
#include "core/result.h"

#include <span>

namespace fidservo::calib {

/// Relative error of the force, r.m.s. of  KV(u) - C sgn(v) - (tau a + v)  over r.m.s. of  KV(u).
///
/// The squares that white noise of the readings has in the numerator, at a level of 1 %, are taken out of it:
/// where accelerations drown in noise, no error of the force shows.
///
/// Position, drive and friction pass through the same zero-phase bell-shaped low-pass of 5 ms standard
/// deviation, the position's second differences too, so that the filter cancels. Ticks slower than a
/// twentieth of the fastest are left out: friction at rest is not the model's to tell. Fails with
/// Reason::not_identifiable if less than 100 ms of motion remains.
Result<double> relative_force_error(std::span<const MacroTrace> traces, const MacroMotion& motion,
                                    double white_noise_mm = 0.0);

}  // namespace fidservo::calib
