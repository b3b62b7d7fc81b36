// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// First-order descending (FOD) curves from slow temperature cycles of different peaks, and the table that
// they give: the way the published stage was identified, in a kiln with a 14 um encoder.
//
// From the coldest temperature the wire is heated to a peak a and cooled back: while it heats, it shows f(T,
// T); while it cools, f(a, T). Each branch is read at the grid's temperatures by a straight line through the
// samples around it, which averages the encoder's steps out. The table is the non-negative density
// (calib/wire/preisach_fit.h) that explains all samples of the cycles: it rises with both temperatures,
// as it must; peaks between those measured are interpolated by the smoothest density that cross-validation
// allows.
#include "calib/wire/preisach_fit.h"
#include "core/result.h"

namespace fidservo::calib {

struct FodOptions {
    /// Of the table, 3..80.
    std::size_t nodes = 31;
    /// Reversals of the temperature below this are its noise; noise_reversal if absent.
    std::optional<double> least_reversal = {};
    /// Resolution of the displacement; smallest_step if absent.
    std::optional<double> output_step = {};
};

/// f at one of the grid's temperatures, with its standard error.
struct FodReading {
    double temp;
    double output;
    double std;
};

struct FodCurve {
    double peak = 0.0;  ///< measured, not rounded to the grid
    std::vector<FodReading> readings;
};

struct FodIdentification {
    FodCurve ascending;                ///< f(T, T); its peak is the highest
    std::vector<FodCurve> descending;  ///< highest peak first
    PreisachFit fit;
    double readings_rms;          ///< of table minus readings
    std::size_t cycles_left_out;  ///< that did not start at the cold end: their curves are of higher order
};

/// Fails with Reason::not_identifiable where fit_preisach does, and without two curves of different peaks.
Result<FodIdentification> identify_fod(const HysteresisTrace& trace, const FodOptions& options = {});

}  // namespace fidservo::calib
