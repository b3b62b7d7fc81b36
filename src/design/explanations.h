// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What recordings leave open: explanations that do equally well, and how far their values may be off.
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
    /// What its values may be off by, in their own units and in order: values + spread z with z normal, mean
    /// 0 and variance 1. A column that is one-sided goes from a bound inwards, and takes |z|.
    Eigen::MatrixXd spread;
    std::vector<bool> is_one_sided;
    /// The values that fit best, and others drawn from the spread that the recordings do not contradict.
    std::vector<gap::Hypothesis> draws;
};

/// The rig is as the one says; how well is it told from the other? Places among the explanations.
struct Duel {
    std::size_t truth, rival;
};

struct OpenQuestion {
    std::vector<Explanation> explanations;  ///< the diagnosis's own first
    std::vector<Duel> duels;
    std::optional<Unknown> unknown;      ///< what is unexplained, where no equation is proposed for it
    std::vector<std::string> separates;  ///< effects, "equation" for the one proposed

    bool is_open() const { return !duels.empty() || unknown; }
};

/// The hypothesis's values moved by spread z, within their bounds.
gap::Hypothesis moved(const Explanation& explanation, const Eigen::VectorXd& z);

/// The diagnosis's explanation against that with a rival in the place of one of its effects, both ways; where
/// one contains the other as its plainer form (plant::Effect::plainer) only that way in which the richer one
/// is the truth, as a richer one follows whatever its plainer form does and the diagnosis then names the
/// plainer one. Against the proposed equation it stands with what the equation takes the place of, that way
/// in which the equation is the truth. Throws BudgetEnded.
OpenQuestion open_question(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis);

}  // namespace fidservo::design
