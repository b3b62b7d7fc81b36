// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether the forces of a hypothesis balance along the way that a carriage was recorded to go, without
// following it.
//
//     V(w(u, y)) - F(v, y) - (tau dv/dt + v) / K = 0
//
// and where a belt pulls the carriage (plant/transmission.h), whose motor follows from V and that way,
//
//     q / K - F(v, y) - (1 - m) tau dv/dt / K = 0
//
// under the truth, with place and velocity from the readings, as a mean over short supports
// (gap/balance/carriage_forces.h). Every force is in it as it is: what two causes do adds up, and no start in
// time leads a fit astray, as it does where friction lets a carriage go by jumps. Not seen are play, how far
// bristles are bent, and all that shows only where the carriage stands.
#include "gap/balance/carriage_forces.h"
#include "plant/stage_plant.h"

#include <vector>

namespace fidservo::gap {

class ForceBalance {
  public:
    /// Standard deviations that excess forces are told in: what rounding leaves counts for little then.
    static constexpr double deviations = 2.5;

    /// @param wanted  windows of the encoder that are looked at
    /// @param half_support  as of CarriageForces
    ForceBalance(const Evidence& evidence, const Wanted& wanted,
                 std::size_t half_support = short_half_support);

    /// The force that each support has in excess, over `deviations` standard ones by the floor of the
    /// readings under the rig file; laid out like Errors, at the value of the support's middle row, NaN
    /// elsewhere.
    Errors excess(const Hypothesis& hypothesis) const;

    /// The same over those under the hypothesis: on the readings' acceleration acts what
    /// mass it leaves the carriage.
    Errors excess_in_own_deviations(const Hypothesis& hypothesis) const;

    /// How far the places are apart at which the carriage slides, mm.
    double way_mm() const;

    /// The middles of the supports in Errors.
    const std::vector<CarriageForces::Support>& supports() const { return forces_.supports(); }

  private:
    Errors excess(const plant::PlantParameters& parameters) const;

    const Evidence& evidence_;
    CarriageForces forces_;
    Column velocity_, acceleration_;
    std::vector<std::vector<double>> readings_mm_;  ///< of each run
};

/// Whether an effect changes forces of the carriage, not just how they reach it.
bool shows_in_balance(const plant::Effect& effect);

}  // namespace fidservo::gap
