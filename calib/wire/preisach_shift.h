// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How far load moves a wire's transformation temperatures: the loop of one stress, moved along the
// temperature, against the loop of another (the effect stress_shift).
#include "calib/wire/preisach_fit.h"
#include "core/result.h"

namespace fidservo::calib {

struct TemperatureShift {
    double shift;  ///< the second loop lies this much higher, in the unit of the input
    double shift_std;
    double rms;  ///< of the output, with that shift
    double rms_unshifted;
};

/// Least squares over one shift: prediction of the model for input - shift, minus output. The offset is the
/// model's own.
/// Fails with Reason::not_identifiable on a trace that fit_preisach would refuse, and where the best shift is
/// as large as half the table's range.
Result<TemperatureShift> fit_temperature_shift(const PreisachFit& model, const HysteresisTrace& trace);

}  // namespace fidservo::calib
