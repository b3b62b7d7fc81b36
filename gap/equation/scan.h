// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Trials of single terms of a port with larger coefficients. Some effects, such as shifts of a hysteresis,
// are not linear in their coefficient, so that sparse regression (gap/equation/screening.h) may miss them.
#include "gap/equation/sketch.h"
#include "gap/fit/cross_fit.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Sketches of one term each, with the best of a few coefficients, judged on the recordings with the largest
/// loss; best first. Empty for ports of the carriage and the encoder.
/// @param beside  the explanation to which the terms are added
std::vector<Sketch> scanned(const Evidence& evidence, const CrossFit& beside, plant::Port port,
                            const std::vector<Term>& terms, std::size_t count);

}  // namespace fidservo::gap
