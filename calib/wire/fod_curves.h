// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// First-order descending (FOD) curves from slow temperature cycles of different peaks, and the table that
// follows from them. The published stage was identified in this way, in an oven with a 14 um encoder.
//
// From the coldest temperature the wire is heated to a peak a and cooled back: while it heats, it shows f(T,
// T); while it cools, f(a, T). Each branch is read at the grid's temperatures by a straight line through the
// samples around them, which averages out the encoder's steps. The table is that of the non-negative density
// (calib/wire/preisach_fit.h) that explains all samples of the cycles, so that it increases with both
// temperatures; between the measured peaks it is interpolated by the smoothest density that cross-validation
// allows.
#include "calib/wire/preisach_fit.h"
#include "core/result.h"

namespace fidservo::calib {

struct FodOptions {
    /// Number of nodes of the table, 3..80.
    std::size_t nodes = 31;
    /// Smaller reversals of the temperature count as noise; empty: noise_reversal().
    std::optional<double> least_reversal = {};
    /// Resolution of the displacement; empty: smallest_step().
    std::optional<double> output_step = {};
};

/// f at one of the grid's temperatures, with its standard error.
struct FodReading {
    double temp;
    double output;
    double std;
};

struct FodCurve {
    double peak = 0.0;  ///< as measured, not rounded to the grid
    std::vector<FodReading> readings;
};

struct FodIdentification {
    FodCurve ascending;                ///< f(T, T), up to the highest peak
    std::vector<FodCurve> descending;  ///< highest peak first
    PreisachFit fit;
    double readings_rms;  ///< r.m.s. of table minus readings
    /// Cycles that did not start at the coldest temperature: their curves are of higher order.
    std::size_t cycles_left_out;
};

/// Fails with Reason::not_identifiable where fit_preisach() does, and if there are not two curves with
/// different peaks.
Result<FodIdentification> identify_fod(const HysteresisTrace& trace, const FodOptions& options = {});

}  // namespace fidservo::calib
