// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The probability that a named effect is present.
//
// The evidence for a named effect is a few numbers that anybody can check (Support in gap/diagnosis.h). A
// logistic regression turns them into a probability, which increases or stays the same with each:
//
//     p = 1 / (1 + exp(-(c_0 + sum_k c_k x_k))),   c_k >= 0 for k > 0
//
// Its coefficients were fitted to self-checks with seeds of their own (gap/verdict/calibration.h).
#include "gap/diagnosis.h"
#include "gap/search/selection.h"
#include "gap/verdict/model_weights.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// The regression's features, by name.
inline constexpr std::array<std::string_view, 9> feature_names{
    "weight_logit", "log_discrepancy", "log_own_discrepancy", "log_gain", "log_gap_left", "log_names",
    "halves_agree", "leaves_nothing",  "leaves_no_dependence"};
using Features = std::array<double, feature_names.size()>;

/// The features x_k of a named effect, each larger the stronger the evidence; logarithms are natural:
///   weight_logit   log(w / (1 - w)) of the weight w, -7 .. 7
///   log_discrepancy  -log of the total gap that remains in excess of the floor, sqrt(g^2 - 1), limited to
///                  0.15 .. 3 floors: larger gaps give no more information, as the floor is that of the
///                  sensors, not of the model
///   log_own_discrepancy  the same of the error that remains in the signals that determine the effect
///   log_gain       log of the error without the effect over that with it, in the signals that determine it
///   log_gap_left   -log of the fraction of the total gap that remains, 1e-4 at least
///   log_names      log of the number of named effects: many small ones less often imitate another one
///   halves_agree   -log of the relative difference of its size between the halves, 1e-3 at least
///   leaves_nothing  1 if the signals that determine it come to their floors, else 0
///   leaves_no_dependence  0 if a quantity is found on which the remaining errors of these signals depend,
///                  else 1
Features features_of(const Support& support);

/// The probability by a regression with this offset and these coefficients.
double logistic_probability(const Features& features, double offset, const Features& coefficients);

/// Whether a named effect has to share its probability with another explanation of the same data: the result
/// of a residual analysis (Support::is_contested), which for causes in camera and plate is as reliable as a
/// name, since these are a matter of geometry alone; or, if a parameter is at its bound, the possibility that
/// no rig has as much of the effect as fits best.
bool has_a_rival(const Support& support);

/// The probability by the calibrated regression, or half of it if has_a_rival(), which is too rare to be a
/// feature of the regression.
double calibrated_probability(const Support& support);

/// Signals that an explanation leaves off their floors.
struct SignalsLeft {
    SignalFlags off{};        ///< off their floors
    SignalFlags dependent{};  ///< of these, those with a dependence found, or not analysed
};

/// Whether an effect displaces tags by itself: one of the camera, of what it sees, or of the encoder's
/// reading, by which tags are predicted.
bool shows_in_view(const plant::Effect& effect);

/// The evidence for each choice of a selection.
/// @param left  signals that the whole explanation leaves off their floors
/// @param whole  residual analysis of the whole gap, without named effects; empty: unknown
std::vector<Support> supports(const Evidence& evidence, const Selection& selection,
                              const std::vector<ChoiceWeights>& weights, const SignalsLeft& left,
                              const std::optional<Remainder>& whole);

/// The evidence for an effect that was tried alone, as if it were the only name.
/// @param weight  among all that were tried alone
/// @param gap     before and after it
Support support_alone(const Evidence& evidence, const Trial& trial, const CrossFit& nothing, double weight,
                      const TotalGap& gap);

}  // namespace fidservo::gap
