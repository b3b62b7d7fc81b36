// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     seed 7650, 8 cases of three, messy, messy-none, commit d43d7ea060be
//     seed 7651, 8 cases of three, messy, messy-none, commit d43d7ea060be
//     seed 7652, 8 cases of three, messy, messy-none, commit d43d7ea060be
//     seed 7670, 20 cases of one, two, withheld, unlisted, commit d43d7ea060be
//     seed 7671, 20 cases of one, two, withheld, unlisted, commit d43d7ea060be
//     seed 7672, 20 cases of one, two, withheld, unlisted, commit 7e75c5d0c6cc
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -4.511;
inline constexpr std::array calibrated_coefficients{
    0.295,  // weight_logit
    0.915,  // log_discrepancy
    0.000,  // log_own_discrepancy
    0.054,  // log_gain
    0.000,  // log_gap_left
    1.460,  // log_names
    0.439,  // halves_agree
    0.000,  // in_bounds
    0.000,  // leaves_nothing
};

}  // namespace fidservo::gap
