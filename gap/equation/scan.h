// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which terms of a port help most in a larger amount: what shifts a hysteresis is not linear in its amount,
// and sparse regression (gap/equation/screening.h) may not see it.
#include "gap/equation/sketch.h"
#include "gap/fit/cross_fit.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Sketches of one term each, the best of a few amounts, by the recordings that lose most; best first. None
/// of the carriage and the encoder.
/// @param beside  the explanation that they are tried beside
std::vector<Sketch> scanned(const Evidence& evidence, const CrossFit& beside, plant::Port port,
                            const std::vector<Term>& terms, std::size_t count);

}  // namespace fidservo::gap
