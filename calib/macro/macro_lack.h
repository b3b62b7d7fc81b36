// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Lack-of-fit tests of the macro stage's model: tests of its residuals for forces that the model does not
// contain.
//
// A force g, expressed as a speed in mm/s like that of the drive, would change the position by the solution
// of tau dv/dt = g - v, dy/dt = v in every window. Lagrange multiplier tests, robust to correlated errors:
// the scores of these columns, made orthogonal to parameters and initial states and summed over batches of
// windows, are tested by Hotelling's T^2 (Boos, On generalized score tests, The American Statistician 46(4),
// 1992).
#include "calib/macro/macro_fit.h"

#include <string>
#include <vector>

namespace fidservo::calib {

struct MacroLack {
    std::string depends_on;  ///< what the force depends on, in words
    double probability;      ///< p-value: probability of such scores without the force
    double share;            ///< fraction of the residual's sum of squares that it would remove
    MacroVector shift;       ///< change of the fitted parameters if the model contained it
};

struct MacroLacks {
    /// The forces that are significant at a level of 1 % over all that are tried, the largest share first.
    std::vector<MacroLack> found;
    /// Sum of squares over all windows of the motion that the drive causes, with initial states refitted,
    /// counts^2.
    double drive_squares_count2;
};

MacroLacks lacks_of(const MacroEstimator& estimator, const MacroFit& fit);

/// Mean square change of a figure of the model, over the models that would each have one of the missing
/// forces, weighted by MacroLack::share: the variance that comes from not knowing the right model (Buckland,
/// Burnham, Augustin, Model selection: an integral part of inference, Biometrics 53(2), 1997).
/// @param gradient  of the figure, with respect to the parameters
double shift_variance(const std::vector<MacroLack>& lacks, const MacroVector& gradient);

}  // namespace fidservo::calib
