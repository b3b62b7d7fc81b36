// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tests whether designed experiments resolve ties of a diagnosis: the experiment is recorded on the case's
// rig, and everything is diagnosed again.
#include "gap/diagnosis.h"
#include "src/selfcheck/draw/case_draw.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::selfcheck {

/// A diagnosis with one additional recording.
struct Settlement {
    std::string experiment;  ///< "designed", or an experiment of the list
    double log_odds = 0.0;   ///< expected log odds for the pair of explanations that it distinguishes worst
    bool is_resolved = false;
    std::vector<std::string> named;  ///< effects named, each with those with which it is still tied: "a|b"
};

struct Tie {
    std::vector<std::string> set;  ///< effects of the first diagnosis, as in Settlement::named
    bool holds_truth = false;      ///< the set contains the class of each true effect
    /// With the designed experiment, and with the best one of the list; empty if it is not expected to give
    /// odds of a thousand to 1.
    std::optional<Settlement> by_design, by_list;
    double design_s = 0.0;  ///< wall clock
};

/// One line: the tie, and the result of each experiment.
std::string words_of(const Tie& tie);

using DiagnoseAgain = std::function<gap::Diagnosis(std::vector<Recording>)>;

/// Records the designed experiment and, separately, the best one of the list of experiments on the case's
/// rig, and diagnoses each together with the previous recordings. A tie is resolved if only the true effects
/// are named and none of them is tied with another class. Empty if the diagnosis has no tie.
std::optional<Tie> settle_tie(const Rig& nominal, const Case& drawn, const std::vector<Recording>& recordings,
                              const gap::Diagnosis& diagnosis, const DiagnoseAgain& diagnose_again);

}  // namespace fidservo::selfcheck
