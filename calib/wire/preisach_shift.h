// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The shift of a wire's transformation temperatures with load: the hysteresis loop at one stress, shifted
// along the temperature, is fitted to the loop at another one (the effect stress_shift).
#include "calib/wire/preisach_fit.h"
#include "core/result.h"

namespace fidservo::calib {

struct TemperatureShift {
    double shift;  ///< shift of the second loop towards higher inputs, in the unit of the input
    double shift_std;
    double rms;  ///< r.m.s. residual of the output with that shift
    double rms_unshifted;
};

/// Least squares over the shift: the model's prediction for input - shift, minus output. The offset is that
/// of the model.
/// Fails with Reason::not_identifiable on a trace that fit_preisach() would refuse, and where the best shift
/// is as large as half the table's range.
Result<TemperatureShift> fit_temperature_shift(const PreisachFit& model, const HysteresisTrace& trace);

}  // namespace fidservo::calib
