// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     seed 7650, 8 cases of three, messy, messy-none, commit a55200885910
//     seed 7651, 8 cases of three, messy, messy-none, commit a55200885910
//     seed 7652, 7 cases of three, messy, messy-none, commit a55200885910
//     seed 7670, 20 cases of one, two, withheld, unlisted, commit a55200885910
//     seed 7671, 20 cases of one, two, withheld, unlisted, commit a55200885910
//     seed 7690, 8 cases of rough, commit a55200885910
//     seed 7691, 8 cases of rough, commit a55200885910
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -3.460;
inline constexpr std::array calibrated_coefficients{
    0.222,  // weight_logit
    0.000,  // log_discrepancy
    0.000,  // log_own_discrepancy
    0.523,  // log_gain
    0.000,  // log_gap_left
    0.364,  // log_names
    0.252,  // halves_agree
    2.095,  // leaves_nothing
    0.000,  // leaves_no_dependence
};

}  // namespace fidservo::gap
