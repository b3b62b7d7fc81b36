// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Compares a diagnosis with the true causes of its case. Labels are read nowhere else.
//
// Effects are compared by class. An effect found stands for the set of classes from which it is said to be
// indistinguishable, its own included; it is right if a true cause is in its set.
#include "gap/diagnosis.h"
#include "src/selfcheck/draw/label.h"
#include "src/selfcheck/tally/equation_score.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace fidservo::selfcheck {

/// A wrong name with at least this probability counts as confidently wrong. The second value is for rigs with
/// many causes at once.
inline constexpr double confident = 0.9, confident_of_crowded = 0.5;

/// The set of classes for which an effect found stands, its own included.
std::set<std::string> classes_named(const gap::FoundEffect& found);

/// An effect that a diagnosis names.
struct NamedEffect {
    std::string effect, class_name;
    bool is_true;  ///< the set of classes that it stands for contains a true cause
    double probability;
    gap::Support support = {};
    /// Whether an equation that is proposed in place of this name is likelier and took over most of its
    /// probability (gap/proposal.h).
    bool is_replaced = false;
    double gap_before,
        gap_after;  ///< gap over all signals, in floors, with the effects before it, and with it in addition
};

struct Score {
    gap::Verdict verdict = gap::Verdict::no_gap;
    /// Largest r.m.s. error of the rig file's prediction among the signals, in floors.
    double floors = 0.0;
    double before = 1.0, after = 1.0, removed = 0.0;  ///< gap over all signals

    double floors_left = 0.0;  ///< the same, with the explanation

    std::vector<NamedEffect> named;  ///< in the diagnosis's order
    std::string first_block;         ///< the block named first; empty: none
    double first_probability = 0.0;  ///< probability of the effect named first; 0 where none is named
    std::size_t set_size = 0;        ///< number of classes in the first effect's set

    bool right_block_first = false;  ///< the first block is that of a true effect or of one of its class
    bool right_effect_first = false;
    bool any_right = false;           ///< an effect found is a true one
    std::size_t truths_named = 0;     ///< number of true effects that are found, each by a name of its own
    bool all_right = false;           ///< every true effect is found, and no other
    bool is_confident_wrong = false;  ///< a wrong effect is found with high probability
    bool says_unexplained = false;    ///< the verdict is unexplained or partly-explained

    /// For a messy rig: index of its dominant effect among those named.
    std::optional<std::size_t> dominant_place;
    /// For a messy rig: the fraction of the true effects' contribution to the squared gap that the
    /// explanation removes. Without the true effects' contribution, the gap of the discrepancy alone remains.
    std::optional<double> removed_of_true;
    /// For a case whose effect cannot be named but can be stated as a formula.
    std::optional<EquationScore> equation;
    bool proposes_equation = false;
};

/// Scores a diagnosis. Every name is wrong for a case whose effect was withheld or is not in the catalogue.
/// @param evidence  the evidence that was diagnosed; nullptr: equations are not scored
Score score(const Label& label, const gap::Diagnosis& diagnosis, const gap::Evidence* evidence = nullptr);

}  // namespace fidservo::selfcheck
