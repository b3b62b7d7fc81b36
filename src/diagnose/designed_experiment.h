// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The experiment that is designed to decide what a diagnosis leaves open.
#include "gap/diagnosis.h"
#include "src/design/design_experiment.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::diagnose {

/// Longest time for a design in addition to the diagnosis, s; the search takes four fifths of it.
inline constexpr double design_limit_s = 60.0;

struct DesignRequest {
    std::filesystem::path file;             ///< the experiment file to be written, .yaml
    std::optional<double> wire_limit_degC;  ///< limit of `record` for the wire's temperature
    double limit_s = design_limit_s;
    design::DesignEffort effort = {};
};

struct DesignedNext {
    std::filesystem::path file;
    std::string name;  ///< name of the experiment: that of the file, as far as its characters are allowed
    design::OpenQuestion question;
    design::Candidate candidate;
    /// For each of the question's duels, whether it counts (src/design/design_experiment.h).
    std::vector<bool> decidable;
    gap::Ended ended = gap::Ended::finished;
};

/// A design, or one line with the reason why there is none.
struct DesignAnswer {
    std::shared_ptr<const DesignedNext> next;  ///< nullptr: no design
    std::string why_none;
};

/// No experiment is designed where nothing is open, where the user interrupted before anything was judged, or
/// where odds of a thousand to 1 cannot be reached.
/// @param evidence  its budget must still be running
DesignAnswer design_next(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                         const DesignRequest& request, const design::Tell& tell);

/// The experiment file's text: its purpose in comments, and the pieces.
std::string file_text(const DesignedNext& next);

/// The design in the form in which a diagnosis proposes experiments.
gap::ProposedExperiment proposal_of(const DesignedNext& next);

/// Odds in words: "about 500 to 1", "more than a million to 1".
std::string odds_words(double log_odds);

}  // namespace fidservo::diagnose
