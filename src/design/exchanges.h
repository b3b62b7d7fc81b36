// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The explanations that a diagnosis leaves open beside its own: one of its effects exchanged for a rival.
#include "gap/diagnosis.h"

#include <cstddef>
#include <vector>

namespace fidservo::design {

struct Exchange {
    std::size_t place = 0;                 ///< of the effect, in Diagnosis::effects
    const plant::Effect* rival = nullptr;  ///< that takes its place
    gap::Hypothesis hypothesis;            ///< with the rival, as fitted, in the effect's place
};

/// One for each rival; none for a rival that in the end was found beside the other.
std::vector<Exchange> exchanges(const gap::Diagnosis& diagnosis);

}  // namespace fidservo::design
