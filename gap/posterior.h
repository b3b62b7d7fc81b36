#pragma once
// How probable explanations are, from what they leave on windows that they were not fitted to.
//
// A window's values are correlated, and the model's small faults are not noise: a window counts as
// `values_per_window` independent values,
//
//     p_c ~ exp(-values_per_window sum_w l_w)      l_w: gap/score.h
//
// a number that is set so that the probabilities are true on rigs of another model (docs/diagnosis.md).
#include <span>
#include <vector>

namespace fidservo::gap {

inline constexpr double values_per_window = 1.0;

/// How far the place of named effects is trusted where they still leave a gap: the cause may be none of them.
/// 1 up to 1.1 floors, from there 1 / (1 + 4 log10(floors left / 1.1)).
/// @param floors_left  typical_floors of gap/gap_size.h
double trust_in(double floors_left);

/// What a probability among named effects is worth: 0.99 trust^3. Set on self-checks of seeds 2060 to 2086,
/// where 847 of 853 names were right of which hardly anything spoke against, and on that of seed 2042, where
/// 8 of 27 were at a mean trust of 0.67.
double worth_of_names(double trust);

/// @param losses  of the explanations, each the sum over the same windows
std::vector<double> probabilities(std::span<const double> losses);

}  // namespace fidservo::gap
