// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The uncertainty of the heater's parameters, and combinations of parameters that are determined although the
// single ones are not.
#include "calib/wire/heater_residuals.h"

#include <optional>
#include <vector>

namespace fidservo::calib {

/// A converged fit.
struct HeaterSolution {
    HeaterFit fit;
    HeaterVector x;
    HeaterFree is_free;
    /// The solution before the first parameter was held fixed, if one was. It gives the uncertainty of the
    /// other parameters without the assumption of that fixed value.
    struct Freer {
        HeaterVector x;
        HeaterInfluences influences;
    };
    std::optional<Freer> freer = {};
    /// For each run, the change of x that results if the reading that gives its start temperature is wrong by
    /// the readings' r.m.s. error; empty for runs whose start temperature is given.
    std::vector<HeaterVector> moved_by_starts = {};
};

/// Refuses parameters that are determined only because another one is held fixed, since their errors depend
/// on the error of the fixed one.
void refuse_what_hangs_on_others(HeaterSolution& solution);

/// Standard errors of the common solution, including the effect of parameters held fixed: C + d d^T, with C
/// the covariance of the solution in which these were free and d the difference between the two solutions.
/// Parameters are refused if runs contradict each other on them (at 1 % over all parameters) and no common
/// value is known accurately enough to be useful.
HeaterFit with_errors(const std::vector<HeaterRun>& runs, const HeaterPredict& predict,
                      const HeaterScale& scale, const HeaterSolution& common);

/// Mean of the commands that heat the wire.
double mean_heating_command(const std::vector<HeaterRun>& runs, const HeaterParameters& heater);

/// For a parameter that is not determined: adds to the fit the combination of it and the parameter with which
/// it is confounded, which is determined.
/// @param x  solution of `residuals` with all parameters free, to which `influences` belong
void add_combination(HeaterFit& fit, HeaterNumber number, const HeaterResiduals& residuals,
                     const HeaterScale& scale, const HeaterVector& x, const HeaterInfluences& influences,
                     double command);

}  // namespace fidservo::calib
