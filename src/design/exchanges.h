// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The alternatives that a diagnosis leaves open: its explanation with one effect replaced by a rival.
#include "gap/diagnosis.h"

#include <cstddef>
#include <vector>

namespace fidservo::design {

struct Exchange {
    std::size_t place = 0;                 ///< index of the effect in Diagnosis::effects
    const plant::Effect* rival = nullptr;  ///< the effect that replaces it
    gap::Hypothesis hypothesis;  ///< the explanation with the rival, as fitted, in place of the effect
};

/// An exchange for each rival; none for a rival that is itself in the explanation.
std::vector<Exchange> exchanges(const gap::Diagnosis& diagnosis);

}  // namespace fidservo::design
