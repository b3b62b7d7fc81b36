// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a designed experiment makes of ties: the case's rig records it, and all is diagnosed again.
#include "gap/diagnosis.h"
#include "src/selfcheck/draw/case_draw.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::selfcheck {

/// A diagnosis made with one more recording.
struct Settlement {
    std::string experiment;  ///< "designed", or an experiment of the list
    double log_odds = 0.0;   ///< that it was expected to bring, of the pair that it tells apart worst
    bool is_resolved = false;
    std::vector<std::string> named;  ///< effects, each with what it is still tied with: "a|b"
};

struct Tie {
    std::vector<std::string> set;  ///< of the first diagnosis, as in Settlement::named
    bool holds_truth = false;      ///< each of the case's classes is in it
    /// Nothing where no experiment is expected to bring odds of a thousand to 1.
    std::optional<Settlement> by_design, by_list;
    double design_s = 0.0;  ///< wall clock
};

/// One line: what was tied, and what each experiment has made of it.
std::string words_of(const Tie& tie);

using DiagnoseAgain = std::function<gap::Diagnosis(std::vector<Recording>)>;

/// Records the designed experiment and, apart from it, the best one of the list on the case's rig and
/// diagnoses each beside the recordings that there were. A tie is resolved if the case's effects alone are
/// named and none is tied with another class. Nothing where the diagnosis has no tie.
std::optional<Tie> settle_tie(const Rig& nominal, const Case& drawn, const std::vector<Recording>& recordings,
                              const gap::Diagnosis& diagnosis, const DiagnoseAgain& diagnose_again);

}  // namespace fidservo::selfcheck
