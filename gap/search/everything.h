// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Backward elimination: all candidates of signals whose predictions change smoothly with the candidates'
// sizes are fitted at once; then those that the data do not need are removed.
//
// Where several small causes act together, none of them predicts well alone, and the first one accepted
// stands in for the others. All sizes together, with a prior of a few typical sizes about zero, are found in
// some steps of Levenberg-Marquardt (gap/fit/fit.h), far from the optimum by gap/search/approach.h. What each
// saves then follows to second order (gap/search/worth.h), and a fit without those that save too little has
// to confirm that.
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
    /// How the budget's search ended before all was fitted: these candidates are needed as far as is known.
    /// The other half is then fitted in the time for working out; where that ends, too, both halves have the
    /// values of the first one, and the worth is what they save there. Empty: it did not end.
    std::optional<Ended> ended = {};
};

/// Whether predictions of the Hall reading or the tags change smoothly with a candidate's sizes: effects of
/// wire, sensors and view. A scale error of the encoder is one of them, since tags show what hides within its
/// counts.
bool is_smooth(const Candidate& candidate);

/// Whether predictions of a carriage that is predicted nearly right change smoothly with a candidate's sizes:
/// it acts as a force, without play, place or period, and does not hide within the counts.
bool is_smooth_of_carriage(const Candidate& candidate);

/// What is done where the fit of everything does not come near its optimum: what is off is then of another
/// kind, or another signal is still to be explained.
enum class IfFar : std::uint8_t { gives_up, goes_on };

/// Fits all candidates without a shape of their own, and those in `begun`, to the first half, keeps those
/// that are worth it there, fits these to the other half, too, and keeps those that are worth it on both.
/// @param candidates  one of each class
/// @param beside      other settings of each half, which keep their values
/// @param begun       settings of candidates that were found before, from which their fits start
/// @param known       settings of an explanation that is there already: empty if none but these are needed
/// @param wanted      the windows that are fitted in each half
NeededCandidates needed_of_everything(const Evidence& evidence, std::span<const Candidate* const> candidates,
                                      const std::array<Hypothesis, 2>& beside, const Hypothesis& begun,
                                      const Hypothesis& known, const std::array<Wanted, 2>& wanted,
                                      IfFar if_far);

/// Settings of those candidates with a shape of their own that are not in `begun` and promise anything beside
/// all others (gap/starts/shape_screening.h), the one that saves most first.
/// @param waves  settings of waves along the rail to be screened as well; no grid contains their periods. As
/// errors show one of many periods by chance, one has to save a fifth of the loss
/// @param beside, wanted  of the first half; like the other parameters as in needed_of_everything()
Hypothesis promising_shapes(const Evidence& evidence, std::span<const Candidate* const> candidates,
                            std::span<const plant::EffectSetting> waves, const Hypothesis& beside,
                            const Hypothesis& begun, const Wanted& wanted);

}  // namespace fidservo::gap
