// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The balance of the forces of a hypothesis along a carriage's recorded motion, without simulating the
// carriage.
//
//     V(w(u, y)) - F(v, y) - (tau dv/dt + v) / K = 0
//
// and where a belt pulls the carriage (plant/transmission.h), with a motor whose motion follows from V and
// that of the carriage,
//
//     q / K - F(v, y) - (1 - m) tau dv/dt / K = 0
//
// holds for the true forces, with position and velocity from the readings, as a mean over short supports
// (gap/balance/carriage_forces.h). Forces enter linearly: those of two causes add up, and fits have no local
// minima as simulations have where stick-slip makes a carriage move in jumps. Play, the bend of bristles, and
// effects that show only at rest are not detected.
#include "gap/balance/carriage_forces.h"
#include "plant/stage_plant.h"

#include <vector>

namespace fidservo::gap {

class ForceBalance {
  public:
    /// Excess forces are given in units of this many standard deviations, so that rounding has little weight.
    static constexpr double deviations = 2.5;

    /// @param wanted  windows of the encoder to be used
    /// @param known  of its effects, those on the encoder's reading give the positions from readings
    /// @param half_support  as in CarriageForces
    ForceBalance(const Evidence& evidence, const Wanted& wanted, const Hypothesis& known,
                 std::size_t half_support = short_half_support);

    /// The force in excess in each support, over `deviations` standard deviations from the readings' noise
    /// floor under the rig file.
    Errors excess(const Hypothesis& hypothesis) const;

    /// The same over `deviations` standard deviations under the hypothesis, whose moving mass multiplies the
    /// noise of the acceleration.
    Errors excess_in_own_deviations(const Hypothesis& hypothesis) const;

    /// Length of the rail, mm, on which the carriage slides.
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

/// Whether an effect changes the forces on the carriage, and not only their delay or transmission.
bool shows_in_balance(const plant::Effect& effect);

}  // namespace fidservo::gap
