// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Finds the experiment that best decides what recordings leave open.
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

/// Odds of a thousand to 1, where each window counts as one value; with less, an experiment decides nothing.
inline constexpr double least_log_odds = 7.0;

/// An experiment with its detailed judgement.
struct Candidate {
    /// Where it comes from: the name of an experiment of the list, "drawn" or "improved".
    std::string origin;
    Design design;
    Judgement judgement;
};

struct DesignEffort {
    std::size_t drawn = 40;    ///< number of experiments drawn at random
    std::size_t improved = 2;  ///< of all experiments, how many of the best have their numbers improved
    OptimiserEffort optimiser{30, 90};
};

/// Little effort, for many designs in a row.
inline constexpr DesignEffort small_effort{20, 1, {12, 36}};

struct DesignedExperiment {
    std::optional<Candidate> best;  ///< empty where the rig can do no experiment
    /// Which of the question's duels count: those that some experiment decides with odds of a thousand to 1,
    /// or all if none does. An experiment is judged by the worst of these. Where one explanation can mimic
    /// another one in every experiment, only the reverse duel counts.
    std::vector<bool> decidable;
    gap::Ended ended = gap::Ended::finished;  ///< if not finished, the best experiment until then
};

/// Receives the search's progress, in words.
using Tell = std::function<void(std::string_view)>;

/// Judges experiments of the list and randomly drawn ones briefly, improves the best ones, and judges the
/// best of each stage in detail. The result is never worse than the best of the list. Deterministic unless
/// the time runs out.
/// @param name    of the experiment
/// @param budget  which the judge checks: its search part is for the search, the rest for the detailed
/// judgement
DesignedExperiment design_experiment(const Judge& judge, const std::string& name,
                                     const std::shared_ptr<const gap::Budget>& budget,
                                     const DesignEffort& effort = {}, const Tell& tell = {});

/// The best experiment of the rig's list, unchanged; for comparison.
/// @param decidable  the duels that count
std::optional<Candidate> best_of_list(const Judge& judge, const std::vector<bool>& decidable);

}  // namespace fidservo::design
