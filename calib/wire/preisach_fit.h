// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A Preisach model from any excitation: the density that explains the output best, nowhere negative.
//
//     output = offset + direction f,     minimise  |output - offset - direction A w|^2 + penalty |D w|^2,  w
//     >= 0
//
// A: share of each cell that the input has switched on (calib/wire/preisach_grid.h); D: differences of
// neighbouring cells, which spread the density where the data say nothing about it. The penalty is chosen by
// cross-validation over ten stretches of the data, alternately held out. Input and output may have any unit;
// the names of FodTable say degC and mm.
#include "calib/wire/preisach_data.h"
#include "calib/wire/preisach_grid.h"
#include "core/result.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::calib {

/// What the data are, where they do not say so themselves.
struct PreisachFitOptions {
    /// Of the grid, 3..80.
    std::size_t nodes = 25;
    /// Ends of the grid; the data's own range if absent.
    std::optional<double> low = {}, high = {};
    /// The first sample was reached from below all hysteresis: a cold wire.
    bool starts_at_saturation = false;
    /// Reversals of the input below this are its noise; noise_reversal if absent.
    std::optional<double> least_reversal = {};
    /// Samples fitted: [first, last). The memory is tracked from 0 on.
    std::size_t first = 0, last = SIZE_MAX;
};

/// A wire's table, fitted to temperatures and contractions.
struct PreisachFit {
    FodTable table;                ///< f >= 0, f(low, low) = 0
    double offset;                 ///< of the output where the table is zero, in its unit
    double direction;              ///< +1 if the output rises with the input, -1 if it falls
    std::vector<double> node_std;  ///< standard error of each node of the table's lower triangle, row by row
    std::vector<bool> determined;  ///< likewise, see determined_nodes
    double penalty;                ///< relative to the mean information of a cell
    double residual_rms;           ///< root mean square of what the model leaves, in the output's unit
    double held_out_rms;           ///< in the cross-validation, at this penalty
    double correlation_samples;    ///< over which residuals are correlated; in the standard errors
    std::size_t samples;           ///< that entered the fit
    double least_reversal;         ///< the smallest turn of the input in the data, in its unit
};

/// Fails with Reason::not_identifiable on data that are too short, not finite, do not move, or never reach an
/// end of their range after which the memory is known.
Result<PreisachFit> fit_preisach(const HysteresisTrace& trace, const PreisachFitOptions& options = {});

/// The model's output for an input that starts as the fit's did.
std::vector<double> predict(const PreisachFit& fit, std::span<const double> input);

/// R.m.s. of prediction minus output over samples [first, last) of a trace.
double prediction_rms(const PreisachFit& fit, const HysteresisTrace& trace, std::size_t first = 0,
                      std::size_t last = SIZE_MAX);

}  // namespace fidservo::calib
