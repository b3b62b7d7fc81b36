#pragma once
// Coefficients of the probability of a name (gap/verdict/standing.h), written by `./run calibrate` from
// self-checks:
//
//     seed 7650, 8 cases of three, messy, messy-none, commit 9f6dd0bc4ff8-dirty
//     seed 7651, 8 cases of three, messy, messy-none, commit ca0b0c927bfa
//     seed 7652, 8 cases of three, messy, messy-none, commit ca0b0c927bfa
//     seed 7653, 8 cases of three, messy, messy-none, commit ca0b0c927bfa
//     seed 7670, 20 cases of one, two, withheld, unlisted, commit ca0b0c927bfa
//     seed 7671, 20 cases of one, two, withheld, unlisted, commit ca0b0c927bfa
//     seed 7672, 20 cases of one, two, withheld, unlisted, commit ca0b0c927bfa
//     seed 7673, 15 cases of one, two, withheld, unlisted, commit ca0b0c927bfa
#include <array>

namespace fidservo::gap {

inline constexpr double calibrated_offset = -4.560;
inline constexpr std::array calibrated_coefficients{
    0.155,  // weight_logit
    1.005,  // log_discrepancy
    0.190,  // log_gain
    0.257,  // log_gap_left
    0.991,  // log_names
    0.297,  // halves_agree
    0.000,  // agreement
    0.000,  // within_bounds
};

}  // namespace fidservo::gap
