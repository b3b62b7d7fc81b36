// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Beginning with everything: all candidates of signals whose predictions change smoothly with what is wrong,
// fitted at once, and taken away what the data do not need.
//
// Where several small causes are at work, none of them predicts well alone, and what is taken in first stands
// in for the others. All sizes together, each expected within a few typical ones of nothing, are found by
// Levenberg-Marquardt in some steps (gap/fit/fit.h), from far off at a level that follows what is left:
// a^2 = 1 + the median of S_w. What an effect is worth then follows without another fit, from the loss to
// second order: with sizes t of those left out and the inverse C of its second derivatives,
//
//     worth = 1/2 t' C_tt^-1 t
//
// (Wald's statistic; Hosmer, Jovanovic, Lemeshow, Biometrics 45, 1989, for the choice of subsets by it).
#include "gap/candidates/candidate.h"
#include "gap/candidates/coupling.h"
#include "gap/evidence.h"

#include <array>
#include <span>
#include <vector>

namespace fidservo::gap {

/// What was needed of everything.
struct NeededCandidates {
    std::vector<const Candidate*> candidates;
    std::array<Hypothesis, 2> of_half;  ///< as fitted on each half, one setting a candidate
    std::vector<double> worth;          ///< of each, on both halves: loss that it saves beside the others
};

/// Whether what the Hall reading or the tags tell of a candidate changes smoothly with its sizes: of the
/// wire, the sensors and the view. A false scale of the encoder hides within its counts and shows in the
/// tags.
bool is_smooth(const Candidate& candidate);

/// The same of a carriage that is predicted nearly right: without play, place or period, and what does not
/// hide within the counts.
bool is_smooth_of_carriage(const Candidate& candidate);

/// Of all candidates without a shape of their own, and those begun: fits the first half, keeps what is worth
/// it there, fits that on the other half too, and keeps what is worth it on both.
/// @param candidates  one of a class
/// @param beside      what each half knows of what moves the carriage; stays as it is
/// @param begun       of the candidates, what was found to be there already, with its values
/// @param wanted      windows of the Hall reading and tags in each half
NeededCandidates needed_of_everything(const Evidence& evidence, std::span<const Candidate* const> candidates,
                                      const std::array<Hypothesis, 2>& beside, const Hypothesis& begun,
                                      const std::array<Wanted, 2>& wanted);

/// Of those candidates that have a shape of their own and are not begun, the settings which promise most
/// beside everything else (gap/search/shape_screening.h), best first: one a candidate, and none that promises
/// less than half of the best.
/// @param waves  along the rail, whose periods no grid has
/// @param beside, wanted  of the first half; otherwise as above
Hypothesis promising_shapes(const Evidence& evidence, std::span<const Candidate* const> candidates,
                            std::span<const plant::EffectSetting> waves, const Hypothesis& beside,
                            const Hypothesis& begun, const Wanted& wanted);

}  // namespace fidservo::gap
