// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The experiment that tells best what recordings leave open.
#include "gap/budget.h"
#include "src/design/design.h"
#include "src/design/judge.h"
#include "src/design/optimise.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::design {

/// Odds of a thousand to 1 in windows that count as one value each: with less, an experiment decides nothing.
inline constexpr double least_log_odds = 7.0;

/// An experiment, looked at closely.
struct Candidate {
    std::string origin;  ///< an experiment of the list, "drawn" or "improved"
    Design design;
    Judgement judgement;
};

struct DesignEffort {
    std::size_t drawn = 40;    ///< experiments drawn at random
    std::size_t improved = 2;  ///< of all, the best, whose numbers are then improved
    OptimiserEffort optimiser{30, 90};
};

/// For many designs in a row.
inline constexpr DesignEffort small_effort{20, 1, {12, 36}};

struct DesignedExperiment {
    std::optional<Candidate> best;  ///< nothing where the rig can do none
    /// Of the question's duels, those that some experiment decides with odds of a thousand to 1, or would if
    /// any did: the worst of these is what an experiment is judged by. An explanation that in no experiment
    /// can be told from what another one does follows it whatever it does; only the other way counts.
    std::vector<bool> decidable;
    gap::Ended ended = gap::Ended::finished;  ///< otherwise the best until then
};

/// How a search goes on, in words.
using Tell = std::function<void(std::string_view)>;

/// Experiments of the list and others that are drawn are looked at briefly, the best ones are improved, and
/// what was best at each stage is looked at closely; the best of these is never worse than the best of the
/// list. Deterministic where no time ends it.
/// @param name    of the experiment
/// @param budget  that the judge asks: its search part is for the search, the rest for looking closely
DesignedExperiment design_experiment(const Judge& judge, const std::string& name,
                                     const std::shared_ptr<const gap::Budget>& budget,
                                     const DesignEffort& effort = {}, const Tell& tell = {});

/// The experiment of a rig's list, as it is commanded there, that is worth most; for comparison.
/// @param decidable  the duels that count
std::optional<Candidate> best_of_list(const Judge& judge, const std::vector<bool>& decidable);

}  // namespace fidservo::design
