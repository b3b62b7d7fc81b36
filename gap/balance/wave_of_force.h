// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A periodic dependence of the lacking forces on any quantity: on the command, as from the steps of a
// converter, or on the position while the drive pushes, as from an eccentric pulley.
#include "gap/balance/carriage_forces.h"

#include <functional>

namespace fidservo::gap {

/// A period in the unit of the quantity.
struct WaveOfForce {
    double period = 0.0;
    double share = 0.0;  ///< fraction of the weighted squares of the lacking forces that it explains, 0 .. 1
};

/// The period of a quantity whose sine and cosine, times factor_V, explain most of the lacking forces (linear
/// periodogram; a support with a lacking force of l standard deviations has the weight 1 / (1 + l^2)). No
/// period, share 0, if the quantity spans less than two of the shortest periods.
/// @param shortest, longest  period in the unit of the quantity
WaveOfForce strongest_wave(const CarriageForces& forces,
                           const std::function<double(const SlidingRow&)>& quantity,
                           const std::function<double(const SlidingRow&)>& factor_V, double shortest,
                           double longest);

}  // namespace fidservo::gap
