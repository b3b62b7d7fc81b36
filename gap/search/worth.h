// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which of several candidates that were fitted together are needed to explain the data.
//
// The worth of some effects is the loss that they save beside all others. It follows without another fit from
// the loss to second order. With t the sizes of these effects, and C the inverse of the Hessian of the loss
// with respect to all parameters except their shapes, which keep their values (C_tt: the block of C for t),
//
//     worth = 1/2 t' C_tt^-1 t
//
// (Wald's statistic; Hosmer, Jovanovic, Lemeshow, Biometrics 45, 1989, for the choice of subsets by it). The
// shapes of these effects are held, because at size zero they have no effect (Davies, Biometrika 64, 1977),
// whereas the second-order loss would let them compensate a smaller size down to zero. The shapes of the
// remaining effects are free, since they may compensate what is left out.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"
#include "gap/numbers.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Least loss that an effect has to save to be kept. Without the effect, twice the loss saved is the square
/// of a standard normal variable; it exceeds 8 by chance once in 200 cases.
inline constexpr double least_worth = 4.0;

/// A change of the loss that is negligible relative to least_worth.
inline constexpr double hardly_worth = least_worth / percent;

/// The loss that a candidate has to save to be kept: least_worth times a factor. A discrepancy is correlated
/// within a recording, so that its windows are worth fewer independent ones (gap/fit/predictive_density.h);
/// the factor is the ratio of these numbers.
class Demand {
  public:
    /// The demand if the errors are noise only: all factors are 1.
    Demand() { times_.fill(1.0); }

    /// @param errors  in the wanted windows, with all candidates fitted
    Demand(const Evidence& evidence, const Wanted& wanted, const Errors& errors);

    /// The demand for a candidate: with the smallest factor among the signals from which it is estimated.
    double worth_of(const Candidate& candidate) const;

  private:
    std::array<double, signal_count> times_{};
};

/// Indices of the candidates that are kept by backward elimination: the candidate that saves least, relative
/// to its demand, is removed until all save as much as demanded. Several candidates that together imitate a
/// removed one can outlast it. Therefore a removed candidate is put back, and those that save too little
/// beside it are removed, as long as this lowers the sum of the loss and the demands of all that remain.
/// @param fitted  a fit of all candidates, with covariances
/// @param spares_held  whether candidates that a bound holds at size zero are kept: if the fit has not
/// converged yet, they may still leave the bound
std::vector<std::size_t> kept(std::span<const Candidate* const> candidates, const Fit& fitted,
                              const Demand& demand, bool spares_held);

/// Loss that each candidate saves beside the others.
std::vector<double> worth_of_each(std::span<const Candidate* const> candidates, const Fit& fitted);

}  // namespace fidservo::gap
