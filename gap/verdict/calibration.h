// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     seed 7650, 8 cases of three, messy, messy-none, commit 9cbbeb9447ec
//     seed 7651, 8 cases of three, messy, messy-none, commit 9cbbeb9447ec
//     seed 7670, 20 cases of one, two, withheld, unlisted, commit 9cbbeb9447ec
//     seed 7671, 20 cases of one, two, withheld, unlisted, commit 9cbbeb9447ec
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -5.058;
inline constexpr std::array calibrated_coefficients{
    0.370,  // weight_logit
    0.000,  // log_discrepancy
    0.151,  // log_own_discrepancy
    0.378,  // log_gain
    0.000,  // log_gap_left
    0.924,  // log_names
    0.330,  // halves_agree
    1.953,  // leaves_nothing
};

}  // namespace fidservo::gap
