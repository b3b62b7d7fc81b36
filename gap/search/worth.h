// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which of several candidates, fitted together, the data need.
//
// The loss that effects save beside the others (their worth) follows without another fit, from the loss to
// second order: with t their sizes, and C the inverse of the matrix of second derivatives with respect to all
// parameters but the shapes of these effects, which keep their values (C_tt: its block for t),
//
//     worth = 1/2 t' C_tt^-1 t
//
// (Wald's statistic; Hosmer, Jovanovic, Lemeshow, Biometrics 45, 1989, for the choice of subsets by it).
// Their own shapes would, if free to move, make up for a smaller size as long as there is one, but at size
// zero they have no effect (Davies, Biometrika 64, 1977). The shapes of the effects that remain may make up
// for what is left out.
#include "gap/candidates/candidate.h"
#include "gap/fit/fit.h"
#include "gap/numbers.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Least loss that a size has to save to be kept. Twice the loss is the square of a normal deviate, here one
/// that chance exceeds once in 200 cases.
inline constexpr double least_worth = 4.0;

/// A change of the loss that makes no difference beside the least worth.
inline constexpr double hardly_worth = least_worth / percent;

/// The loss that a candidate has to save. A discrepancy is shared by the windows of a recording, which then
/// count as fewer independent ones (gap/fit/predictive_density.h); the demand is larger by that factor.
class Demand {
  public:
    /// The demand where only noise is left.
    Demand() { times_.fill(1.0); }

    /// @param errors  in the wanted windows, with all candidates fitted
    Demand(const Evidence& evidence, const Wanted& wanted, const Errors& errors);

    /// The demand by the signal with the smallest factor among those from which the candidate is estimated.
    double worth_of(const Candidate& candidate) const;

  private:
    std::array<double, signal_count> times_{};
};

/// Indices of the candidates that remain when the one that saves least, relative to what is demanded of it,
/// is removed again and again until all save enough. Several that together stand in for another one can
/// outlast it. So one that was removed comes back, and what saves too little beside it is removed, as long as
/// the loss and the demands of all that remain become less by that.
/// @param fitted  all of them, with covariances
/// @param spares_held  whether candidates without effect that a bound holds there remain: a fit that has not
/// converged may let go of them yet
std::vector<std::size_t> kept(std::span<const Candidate* const> candidates, const Fit& fitted,
                              const Demand& demand, bool spares_held);

/// Loss that each candidate saves beside the others.
std::vector<double> worth_of_each(std::span<const Candidate* const> candidates, const Fit& fitted);

}  // namespace fidservo::gap
