// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The balance of the forces of a hypothesis along a carriage's recorded motion, without simulating the
// carriage.
//
//     V(w(u, y)) - F(v, y) - (tau dv/dt + v) / K = 0
//
// or, if a belt pulls the carriage (plant/transmission.h; the motor's motion follows from V and the
// carriage's motion),
//
//     q / K - F(v, y) - (1 - m) tau dv/dt / K = 0
//
// holds for the true forces, with position and velocity from the readings, as a mean over short supports
// (gap/balance/carriage_forces.h). Forces enter linearly, so that those of several causes add up. Stick-slip,
// which makes the loss of simulations discontinuous, causes no local minima here. Play, the deflection of
// bristles, and effects that show only at rest are not detected.
#include "gap/balance/carriage_forces.h"
#include "plant/stage_plant.h"

#include <vector>

namespace fidservo::gap {

class ForceBalance {
  public:
    /// Excess forces are given in units of this many standard deviations, so that noise and rounding have
    /// little weight.
    static constexpr double deviations = 2.5;

    /// @param wanted  windows of the encoder to be used
    /// @param known  a hypothesis whose effects on the encoder's reading are used to convert readings to
    /// positions
    /// @param half_support  as in CarriageForces
    ForceBalance(const Evidence& evidence, const Wanted& wanted, const Hypothesis& known,
                 std::size_t half_support = short_half_support);

    /// The excess force of a hypothesis, the left side of the balance above, in each support. Unit:
    /// `deviations` standard deviations, which follow from the readings' noise floor and the rig file's
    /// parameters.
    Errors excess(const Hypothesis& hypothesis) const;

    /// excess() with standard deviations that follow from the hypothesis's parameters: its moving mass
    /// multiplies the noise of the acceleration.
    Errors excess_in_own_deviations(const Hypothesis& hypothesis) const;

    /// Length of the range of positions, mm, in which the carriage slides.
    double way_mm() const;

    /// How many supports there are.
    std::size_t supports() const { return forces_.supports().size(); }

    /// The windows with the ranges of their supports (CarriageForces::windows).
    const std::vector<Window>& windows() const { return forces_.windows(); }

  private:
    Errors excess(const plant::PlantParameters& parameters) const;

    const Evidence& evidence_;
    CarriageForces forces_;
    Column velocity_, acceleration_;
    std::vector<std::vector<double>> readings_mm_;  ///< for each run
};

/// Whether an effect changes the forces on the carriage. Effects that only delay or transmit forces do not.
bool shows_in_balance(const plant::Effect& effect);

}  // namespace fidservo::gap
