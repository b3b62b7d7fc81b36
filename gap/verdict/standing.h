// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How probable it is that a named effect is there.
//
// What speaks for a name is a few numbers that anybody can check (gap/diagnosis.h: Support). A logistic
// regression makes one probability of them that may only rise with each:
//
//     p = 1 / (1 + exp(-(c_0 + sum_k c_k x_k))),   c_k >= 0 for k > 0
//
// Its coefficients come from self-checks of their own seeds (gap/verdict/calibration.h).
#include "gap/diagnosis.h"
#include "gap/search/selection.h"
#include "gap/verdict/model_weights.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// What the regression is linear in.
inline constexpr std::array<std::string_view, 7> feature_names{
    "weight_logit", "log_discrepancy", "log_gain", "log_gap_left", "log_names", "halves_agree", "agreement"};
using Features = std::array<double, feature_names.size()>;

/// x_k of a name, each larger the more speaks for it; logarithms natural:
///   weight_logit   log(w / (1 - w)) of the weight, -7 .. 7
///   log_discrepancy  -log of what the whole gap that is left exceeds the floor by, sqrt(g^2 - 1), 0.15 to 3
///                  floors: how much further off a machine stays says no more, as the floor is its sensors'
///                  and not its model's
///   log_gain       log of the floors without it over those left, in the signals that teach it
///   log_gap_left   -log of the share of the whole gap that is left, 1e-4 at least
///   log_names      log of how many are named: many small ones stand in for another one less often
///   halves_agree   -log of how far its size differs between halves, 1e-3 at least
///   agreement      0.5 or 1
Features features_of(const Support& support);

/// Of a regression with such an offset and coefficients.
double logistic_probability(const Features& features, double offset, const Features& coefficients);

/// The calibrated regression's, or half of it where there is another account of the same data beside the
/// name: where the analysis without names contradicts it, or where the data want more of it than a rig can
/// have. Such names are too few in self-checks for the regression to learn what they are worth.
double calibrated_probability(const Support& support);

/// Of each choice of a selection.
/// @param whole  what the gap depends on where nothing is named; none where that is not known
std::vector<Support> supports(const Evidence& evidence, const Selection& selection,
                              const std::vector<ChoiceWeights>& weights,
                              const std::optional<Remainder>& whole);

}  // namespace fidservo::gap
