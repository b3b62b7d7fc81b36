#pragma once
// Beginning with everything: all candidates of signals whose predictions change smoothly with what is wrong,
// fitted at once, and taken away what the data do not need.
//
// Where several small causes are at work, none of them predicts well alone, and what is taken in first stands
// in for the others. All sizes together, each expected within a few typical ones of nothing, are found by
// Levenberg-Marquardt in some steps (gap/fit.h), from far off at a level that follows what is left:
// a^2 = 1 + the median of S_w. What an effect is worth then follows without another fit, from the loss to
// second order: with sizes t of those left out and the inverse C of its second derivatives,
//
//     worth = 1/2 t' C_tt^-1 t
//
// (Wald's statistic; Hosmer, Jovanovic, Lemeshow, Biometrics 45, 1989, for the choice of subsets by it).
#include "gap/candidate.h"
#include "gap/coupling.h"
#include "gap/evidence.h"

#include <span>
#include <vector>

namespace fidservo::gap {

/// What was needed of everything, as fitted to the windows wanted.
struct NeededCandidates {
    std::vector<const Candidate*> candidates;
    Hypothesis settings;  ///< one a candidate
};

/// Whether a candidate's predictions change smoothly with its sizes: of the wire, the Hall sensor and the
/// view, of one shape or a few; one of a class.
bool is_smooth(const Candidate& candidate);

/// @param beside   what is known of what moves the carriage; stays as it is
/// @param begun    of the candidates, what was found to be there already, with its values; begins so
/// @param wanted   windows of the Hall reading and tags that are fitted
NeededCandidates needed_of_everything(const Evidence& evidence, std::span<const Candidate* const> candidates,
                                      const Hypothesis& beside, const Hypothesis& begun,
                                      const Wanted& wanted);

/// Settings fitted together from where they are.
Hypothesis fitted_together(const Evidence& evidence, const Hypothesis& beside, const Hypothesis& settings,
                           const Wanted& wanted);

}  // namespace fidservo::gap
