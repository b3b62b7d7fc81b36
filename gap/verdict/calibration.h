// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     seed 7650, 8 cases of three, messy, messy-none, commit b64c189259e2
//     seed 7651, 8 cases of three, messy, messy-none, commit b64c189259e2
//     seed 7670, 20 cases of one, two, withheld, unlisted, commit b64c189259e2
//     seed 7671, 20 cases of one, two, withheld, unlisted, commit b64c189259e2
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -5.239;
inline constexpr std::array calibrated_coefficients{
    0.225,  // weight_logit
    0.000,  // log_discrepancy
    0.270,  // log_own_discrepancy
    0.684,  // log_gain
    0.000,  // log_gap_left
    0.652,  // log_names
    0.483,  // halves_agree
    1.674,  // leaves_nothing
};

}  // namespace fidservo::gap
