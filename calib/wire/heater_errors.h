// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How well the heater's numbers are known, and what is where they are not.
#include "calib/wire/heater_residuals.h"

#include <optional>
#include <vector>

namespace fidservo::calib {

/// A fit that has converged.
struct HeaterSolution {
    HeaterFit fit;
    HeaterVector x;
    HeaterFree is_free;
    /// The solution before the first number was held, if one is: what the others are known to without it.
    struct Freer {
        HeaterVector x;
        HeaterInfluences influences;
    };
    std::optional<Freer> freer = {};
    /// By how much x moves, a run each, if the reading that its temperature starts at is off by as much as
    /// readings are off, r.m.s.; none of runs whose start is given.
    std::vector<HeaterVector> moved_by_starts = {};
};

/// Numbers that are useful only because another one is held are refused: they are as wrong as that one may
/// be.
void refuse_what_hangs_on_others(HeaterSolution& solution);

/// Standard errors of the common solution, with what the numbers that are held may do to the others: C + d^2
/// of the solution that had them free, d the way from it; numbers on which runs contradict each other, 1 %
/// over all numbers, and of which no common value is known to what makes it useful, are refused.
HeaterFit with_errors(const std::vector<HeaterRun>& runs, const HeaterPredict& predict,
                      const HeaterScale& scale, const HeaterSolution& common);

/// Mean of the commands that heat.
double mean_heating_command(const std::vector<HeaterRun>& runs, const HeaterParameters& heater);

/// Where a number is not determined: what is, of it and of the number that it is mistaken for.
/// @param x  of residuals with all numbers free, which `influences` are of
void add_combination(HeaterFit& fit, HeaterNumber number, const HeaterResiduals& residuals,
                     const HeaterScale& scale, const HeaterVector& x, const HeaterInfluences& influences,
                     double command);

}  // namespace fidservo::calib
