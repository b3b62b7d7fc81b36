// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the model of the macro stage lacks: tests of the residual against forces that it does not have.
//
// Each force g (mm/s, as the drive's) would move the place by the solution of  tau dv/dt = g - v, dy/dt = v
// in every window. Lagrange multiplier tests, robust to correlated errors: the scores of these columns, what
// parameters and starts could follow taken out, summed over batches of windows, by Hotelling's T^2 (Boos, On
// generalized score tests, The American Statistician 46(4), 1992).
#include "calib/macro/macro_fit.h"

#include <string>
#include <vector>

namespace fidservo::calib {

struct MacroLack {
    std::string depends_on;  ///< what the force depends on, in words
    double probability;      ///< of scores as large if it is not there
    double share;            ///< of the residual's squares that it would remove
    MacroVector shift;       ///< by how much the parameters would move if the model had it
};

struct MacroLacks {
    /// The forces that are there at a level of 1 % over all that are tried, the largest share first.
    std::vector<MacroLack> found;
    /// Squares over all windows of how far the drive moves the carriage, the starts having followed,
    /// counts^2.
    double drive_squares_count2;
};

MacroLacks lacks_of(const MacroEstimator& estimator, const MacroFit& fit);

/// Variance of a figure's shifts, weighted by the shares of the residual that the forces would remove: the
/// uncertainty of what the model should have been (Buckland, Burnham, Augustin, Model selection: an integral
/// part of inference, Biometrics 53(2), 1997).
double shift_variance(const std::vector<MacroLack>& lacks, const MacroVector& gradient);

}  // namespace fidservo::calib
