// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A wave in any quantity that the forces lacking on a carriage show: of the command, as steps of a converter
// make it, or of the place while the drive pushes, as a pulley makes it that runs out of true.
#include "gap/balance/carriage_forces.h"

#include <functional>

namespace fidservo::gap {

/// In the unit of the quantity.
struct WaveOfForce {
    double period = 0.0;
    double share = 0.0;  ///< of the weighted squares of the forces lacking, 0 .. 1
};

/// The period of a quantity whose sine and cosine, times a factor in V, take most of what is lacking (linear
/// periodogram, a support of l floors weighted 1 / (1 + l^2)); none where the quantity spans less than two of
/// the shortest.
WaveOfForce strongest_wave(const CarriageForces& forces,
                           const std::function<double(const SlidingRow&)>& quantity,
                           const std::function<double(const SlidingRow&)>& factor_V, double shortest,
                           double longest);

}  // namespace fidservo::gap
