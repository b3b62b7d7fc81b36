// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Backward elimination: all candidates of signals whose predictions change smoothly with the candidates'
// sizes are fitted at once; then those that the data do not need are removed.
//
// Where several small causes act together, none of them predicts well alone, and the first one accepted would
// stand in for the others. All sizes together are found in a few steps of Levenberg-Marquardt
// (gap/fit/fit.h), with a prior for the sizes (zero mean, standard deviation of a few typical sizes); a start
// that is far from the optimum is led there by gap/search/approach.h. The loss that each candidate saves then
// follows from the loss to second order (gap/search/worth.h). Those that save too little are removed if a fit
// without them confirms it.
#include "gap/candidates/candidate.h"
#include "gap/candidates/coupling.h"
#include "gap/evidence.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// The candidates that the data need.
struct NeededCandidates {
    std::vector<const Candidate*> candidates;
    std::array<Hypothesis, 2> of_half;  ///< as fitted on each half, one setting for each candidate
    std::vector<double> worth;  ///< for each, the loss that it saves beside the others, on both halves
    /// Why the search was cut short by its budget; empty if it was not. If it was, these are the candidates
    /// that are needed as far as is known, and the second half was fitted in the time for evaluating the
    /// result. If that time ended as well, both halves have the values of the first half, and `worth` is the
    /// loss saved there.
    std::optional<Ended> ended = {};
};

/// Whether a candidate is estimated from Hall reading or tags, whose predictions change smoothly with its
/// sizes: effects on wire, sensors and view. A scale error of the encoder is one of them, since the tags show
/// parts of a count.
bool is_smooth(const Candidate& candidate);

/// Whether predictions of the encoder change smoothly with a candidate's sizes, once the carriage is
/// predicted nearly right: true for forces without a place or a period, false for play and for a scale error
/// of the encoder, which shows in steps of a count only.
bool is_smooth_of_carriage(const Candidate& candidate);

/// What needed_of_everything() does if the fit of all candidates does not come near an optimum, because the
/// cause is of another kind or another signal has to be explained first: return no candidates, or eliminate
/// all the same.
enum class IfFar : std::uint8_t { gives_up, goes_on };

/// Fits all candidates without shape parameters, and those in `begun`, to the first half and keeps those that
/// save enough loss there (gap/search/worth.h); then fits these to the second half and keeps those that save
/// enough on both.
/// @param candidates  one of each class of effects that no data can distinguish
/// @param beside  settings of other effects on each half, which keep their values
/// @param begun  settings of candidates that were found before: start values
/// @param known  settings of the present explanation; the result is empty if no other candidates than these
/// are needed
/// @param wanted      the windows that are fitted in each half
NeededCandidates needed_of_everything(const Evidence& evidence, std::span<const Candidate* const> candidates,
                                      const std::array<Hypothesis, 2>& beside, const Hypothesis& begun,
                                      const Hypothesis& known, const std::array<Wanted, 2>& wanted,
                                      IfFar if_far);

/// Start settings of those candidates with shape parameters that are not in `begun` and are estimated to save
/// loss beside all other candidates (gap/starts/shape_screening.h), the one that saves most first.
/// @param waves  settings of waves along the rail to be screened as well; no grid contains their periods.
/// Each has to save a fifth of the loss, since errors show one of many periods by chance
/// @param beside, wanted  of the first half; like the other parameters as in needed_of_everything()
Hypothesis promising_shapes(const Evidence& evidence, std::span<const Candidate* const> candidates,
                            std::span<const plant::EffectSetting> waves, const Hypothesis& beside,
                            const Hypothesis& begun, const Wanted& wanted);

}  // namespace fidservo::gap
