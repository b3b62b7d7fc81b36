#pragma once
// How well the heater's numbers are known, and what is where they are not.
#include "calib/actuator/heater_residuals.h"

namespace fidservo::calib {

/// A fit that has converged.
struct HeaterSolution {
    HeaterFit fit;
    HeaterVector x;
    HeaterFree is_free;
};

/// Standard errors of the common solution; numbers on which runs contradict each other, 1 % over all numbers,
/// and of which no common value is known to what makes it useful, are refused.
HeaterFit with_errors(const std::vector<HeaterRun>& runs, const HeaterPredict& predict,
                      const HeaterScale& scale, const HeaterSolution& common);

/// Mean of the commands that heat.
double mean_heating_command(const std::vector<HeaterRun>& runs, const HeaterParameters& heater);

/// Where a number is not determined: what is, of it and of the number that it is mistaken for.
void add_combination(HeaterFit& fit, HeaterNumber number, const HeaterScale& scale, const HeaterVector& x,
                     const HeaterInfluences& influences, double command);

}  // namespace fidservo::calib
