// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     seed 7650, 8 cases of three, messy, messy-none, commit 709d842bb11c
//     seed 7651, 8 cases of three, messy, messy-none, commit 709d842bb11c
//     seed 7652, 8 cases of three, messy, messy-none, commit 709d842bb11c
//     seed 7653, 8 cases of three, messy, messy-none, commit 709d842bb11c
//     seed 7670, 20 cases of one, two, withheld, unlisted, commit 709d842bb11c
//     seed 7671, 20 cases of one, two, withheld, unlisted, commit 709d842bb11c
//     seed 7672, 20 cases of one, two, withheld, unlisted, commit 709d842bb11c
//     seed 7690, 8 cases of rough, commit 709d842bb11c
//     seed 7691, 8 cases of rough, commit 709d842bb11c
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -2.740;
inline constexpr std::array calibrated_coefficients{
    0.113,  // weight_logit
    0.398,  // log_discrepancy
    0.320,  // log_own_discrepancy
    0.527,  // log_gain
    0.000,  // log_gap_left
    0.817,  // log_names
    0.422,  // halves_agree
    1.610,  // leaves_nothing
};

}  // namespace fidservo::gap
