// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The experiment that is designed for what a diagnosis leaves open.
#include "gap/diagnosis.h"
#include "src/design/design_experiment.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::diagnose {

/// Longest time for a design beyond the diagnosis, of which the search takes four fifths, s.
inline constexpr double design_limit_s = 60.0;

struct DesignRequest {
    std::filesystem::path file;             ///< that is to be written, .yaml
    std::optional<double> wire_limit_degC;  ///< that `record` keeps
    double limit_s = design_limit_s;
    design::DesignEffort effort = {};
};

struct DesignedNext {
    std::filesystem::path file;
    std::string name;  ///< of the experiment: the file's, as far as it may be in one
    design::OpenQuestion question;
    design::Candidate candidate;
    std::vector<bool> decidable;  ///< of the question's duels (src/design/design_experiment.h)
    gap::Ended ended = gap::Ended::finished;
};

/// What was designed, or in one line why nothing was.
struct DesignAnswer {
    std::shared_ptr<const DesignedNext> next;  ///< nullptr: none
    std::string why_none;
};

/// Nothing is designed where nothing is open, where the user has interrupted before anything was judged, and
/// where odds of a thousand to 1 are not to be had.
/// @param evidence  whose budget is still running
DesignAnswer design_next(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                         const DesignRequest& request, const design::Tell& tell);

/// The experiment file's text: what it is for, in comments, and the pieces.
std::string file_text(const DesignedNext& next);

/// As the diagnosis proposes it.
gap::ProposedExperiment proposal_of(const DesignedNext& next);

/// Odds in words: "about 500 to 1", "more than a million to 1".
std::string odds_words(double log_odds);

}  // namespace fidservo::diagnose
