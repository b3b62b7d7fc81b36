// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What recordings leave open: explanations that are equally good, and the uncertainty of their values.
#include "gap/diagnosis.h"
#include "src/design/unknown.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace fidservo::design {

/// A hypothesis with the values that fit the recordings best.
struct Explanation {
    std::string name;
    gap::Hypothesis hypothesis;
    /// The uncertainty of its values, in their own units and order: values + spread z with independent
    /// standard normal z. A one-sided column goes from a bound inwards and is multiplied by |z|.
    Eigen::MatrixXd spread;
    std::vector<bool> is_one_sided;
    /// The best values, and others drawn from the spread that are compatible with the recordings.
    std::vector<gap::Hypothesis> draws;
};

/// A question for an experiment: if the rig is as explanation `truth` says, how well is it distinguished from
/// the rival? Both are indices of explanations.
struct Duel {
    std::size_t truth, rival;
};

struct OpenQuestion {
    std::vector<Explanation> explanations;  ///< the diagnosis's own is first
    std::vector<Duel> duels;
    std::optional<Unknown> unknown;      ///< the unexplained remainder, where no equation is proposed for it
    std::vector<std::string> separates;  ///< names of effects, and "equation" for the proposed one

    bool is_open() const { return !duels.empty() || unknown; }
};

/// The hypothesis with its values moved by spread z, limited to their bounds.
gap::Hypothesis moved(const Explanation& explanation, const Eigen::VectorXd& z);

/// The duels of the diagnosis's explanation against those with a rival in place of one effect, in both
/// directions. Where one effect contains the other as its simpler form (plant::Effect::plainer), only the
/// direction in which the richer one is true counts, as the richer one can mimic the simpler one and the
/// diagnosis then names the simpler one. A proposed equation has a duel, as the truth, with the explanation
/// that it would replace. Throws BudgetEnded.
OpenQuestion open_question(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis);

}  // namespace fidservo::design
