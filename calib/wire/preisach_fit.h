// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A Preisach model from any excitation: the non-negative density that explains the output best.
//
//     output = offset + direction f,     minimise  |output - offset - direction A w|^2 + penalty |D w|^2
//     over w >= 0
//
// with w the weights of the cells, A the fraction of each cell that the input has switched on
// (calib/wire/preisach_grid.h), and D the differences of neighbouring cells, which smooth the density where
// the data do not determine it. The penalty is chosen by cross-validation over ten stretches of the data,
// which are held out in turn. Input and output may have any unit; the names of FodTable say degC and mm.
#include "calib/wire/preisach_data.h"
#include "calib/wire/preisach_grid.h"
#include "core/result.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::calib {

/// Options; most have defaults that follow from the data.
struct PreisachFitOptions {
    /// Number of nodes of the grid, 3..80.
    std::size_t nodes = 25;
    /// Ends of the grid; empty: the data's own range.
    std::optional<double> low = {}, high = {};
    /// The first sample was reached from negative saturation: a cold wire.
    bool starts_at_saturation = false;
    /// Smaller reversals of the input count as noise; empty: noise_reversal().
    std::optional<double> least_reversal = {};
    /// Samples used in the fit: [first, last). The hysteresis memory is tracked from sample 0 on.
    std::size_t first = 0, last = SIZE_MAX;
};

/// A fitted Preisach model, with the table's standard errors.
struct PreisachFit {
    FodTable table;                ///< f >= 0, f(low, low) = 0
    double offset;                 ///< output where the table is zero, in the output's unit
    double direction;              ///< +1 if the output rises with the input, -1 if it falls
    std::vector<double> node_std;  ///< standard error of each node of the table's lower triangle, row by row
    std::vector<bool> determined;  ///< for each node, whether the data determine it (determined_nodes())
    double penalty;                ///< relative to the mean information of a cell
    double residual_rms;           ///< r.m.s. of the residuals, in the output's unit
    double held_out_rms;  ///< r.m.s. of the held-out residuals in the cross-validation, at this penalty
    /// Correlation length of the residuals in samples, for which the standard errors allow.
    double correlation_samples;
    std::size_t samples;    ///< number of samples used in the fit
    double least_reversal;  ///< size below which reversals of the input were ignored, in its unit
};

/// Fails with Reason::not_identifiable if the data are too short, not finite or constant, or if the input
/// never comes to an end of its range, from which on the hysteresis memory is known.
Result<PreisachFit> fit_preisach(const HysteresisTrace& trace, const PreisachFitOptions& options = {});

/// The model's output for an input that starts from the same state as in the fit.
std::vector<double> predict(const PreisachFit& fit, std::span<const double> input);

/// R.m.s. of prediction minus output over samples [first, last) of a trace.
double prediction_rms(const PreisachFit& fit, const HysteresisTrace& trace, std::size_t first = 0,
                      std::size_t last = SIZE_MAX);

}  // namespace fidservo::calib
