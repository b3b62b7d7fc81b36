// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     seed 7650, 8 cases of three, messy, messy-none, commit ac289236167c
//     seed 7651, 8 cases of three, messy, messy-none, commit ac289236167c
//     seed 7652, 8 cases of three, messy, messy-none, commit ac289236167c
//     seed 7653, 8 cases of three, messy, messy-none, commit ac289236167c
//     seed 7654, 8 cases of three, messy, messy-none, commit ac289236167c
//     seed 7655, 8 cases of three, messy, messy-none, commit ac289236167c
//     seed 7670, 20 cases of one, two, withheld, unlisted, commit ac289236167c
//     seed 7671, 20 cases of one, two, withheld, unlisted, commit ac289236167c
//     seed 7672, 20 cases of one, two, withheld, unlisted, commit ac289236167c
//     seed 7673, 20 cases of one, two, withheld, unlisted, commit ac289236167c
//     seed 7674, 20 cases of one, two, withheld, unlisted, commit ac289236167c
//     seed 7675, 20 cases of one, two, withheld, unlisted, commit ac289236167c
//     seed 7690, 8 cases of rough, commit ac289236167c
//     seed 7691, 8 cases of rough, commit ac289236167c
//     seed 7692, 8 cases of rough, commit ac289236167c
//     seed 7693, 8 cases of rough, commit ac289236167c
//     seed 7694, 8 cases of rough, commit ac289236167c
//     seed 7695, 8 cases of rough, commit ac289236167c
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -2.636;
inline constexpr std::array calibrated_coefficients{
    0.100,  // weight_logit
    0.000,  // log_discrepancy
    0.133,  // log_own_discrepancy
    0.753,  // log_gain
    0.024,  // log_gap_left
    0.314,  // log_names
    0.375,  // halves_agree
    1.182,  // leaves_nothing
    1.040,  // leaves_no_dependence
};

}  // namespace fidservo::gap
