#pragma once
// Which effects explain recordings: forward selection with exchange and deletion, judged on windows that were
// not fitted.
#include "gap/candidate.h"
#include "gap/fit.h"
#include "gap/score.h"

#include <array>
#include <functional>
#include <vector>

namespace fidservo::gap {

/// Which half of the windows a window belongs to. Hypotheses are fitted on one half and judged on the other,
/// both ways. Runs of one experiment go to different halves; where an experiment was run once, stretches of
/// four windows do.
std::vector<std::uint8_t> halves(const Evidence& evidence);

/// A hypothesis fitted on each half.
struct CrossFit {
    std::array<Hypothesis, 2> of_half;
    std::vector<double> mean_squares;  ///< S_w of every window, predicted by what was fitted without its half
    double loss = 0.0;                 ///< of them all
};

/// A candidate that was added to a hypothesis.
struct Trial {
    const Candidate* candidate = nullptr;
    CrossFit fitted;
    Comparison against_base;  ///< with the hypothesis that it was added to
};

/// An effect that was taken in.
struct Choice {
    const Candidate* candidate = nullptr;
    double loss_without = 0.0;           ///< of the rest of the explanation alone
    std::vector<Trial> alternatives;     ///< everything that was tried in its place, itself first
    std::vector<const Candidate*> ties;  ///< of these, what does as well
};

struct Selection {
    std::vector<Choice> choices;  ///< in the order taken in
    std::vector<CrossFit> steps;  ///< with the first 0, 1, 2 ... of them
    std::vector<Trial> alone;     ///< what was tried first, alone, best first
};

struct SelectionOptions {
    int most_effects = 4;
    int fits_per_step = 8;  ///< candidates that are fitted, of those that look best at first sight
    double tail = 0.01;     ///< of taking in anything where there is nothing, over the whole search
};

/// All effects of a cross fit, fitted to all windows from what one half gave.
Fit fit_to_all(const Evidence& evidence, const CrossFit& cross);

Selection select(const Evidence& evidence, const std::vector<Candidate>& candidates,
                 const SelectionOptions& options = {});

}  // namespace fidservo::gap
