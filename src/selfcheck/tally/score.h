// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A diagnosis compared with what its case was made with. Labels are opened here only.
//
// Effects are compared by class. An effect that is found stands for the set of classes that it is said to be
// indistinguishable from, itself included: it is right if the truth is in its set.
#include "gap/diagnosis.h"
#include "src/selfcheck/draw/label.h"
#include "src/selfcheck/tally/equation_score.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace fidservo::selfcheck {

/// A wrong name with this probability or more is a confident wrong name: in most cases, and in rigs with many
/// causes at once.
inline constexpr double confident = 0.9, confident_of_crowded = 0.5;

/// The set of classes that an effect found stands for, its own among them.
std::set<std::string> classes_named(const gap::FoundEffect& found);

/// An effect that a diagnosis names.
struct NamedEffect {
    std::string effect, class_name;
    bool is_true;  ///< the set that it stands for holds an effect of the case
    double probability;
    gap::Support support = {};
    double gap_before,
        gap_after;  ///< over all signals, in floors: without it, with those before it; and with it
};

struct Score {
    gap::Verdict verdict = gap::Verdict::no_gap;
    /// Over the signals: the largest r.m.s. error of the rig file's prediction, in floors.
    double floors = 0.0;
    double before = 1.0, after = 1.0, removed = 0.0;  ///< gap over all signals

    double floors_left = 0.0;  ///< as floors, under the explanation

    std::vector<NamedEffect> named;  ///< in order
    std::string first_block;         ///< empty: none
    double first_probability = 0.0;  ///< of the first effect; 0 where none is named
    std::size_t set_size = 0;        ///< of the first effect's set, in classes

    bool right_block_first = false;  ///< of any true effect or of one of its class
    bool right_effect_first = false;
    bool any_right = false;           ///< an effect found is a true one
    std::size_t truths_named = 0;     ///< true effects that are found, each by a name of its own
    bool all_right = false;           ///< each true effect is found, and no other
    bool is_confident_wrong = false;  ///< one that is found is none of the case's and claims to be sure
    bool says_unexplained = false;    ///< verdict unexplained or partly-explained

    /// Of a messy rig: where among the named its dominant effect is, from 0 on.
    std::optional<std::size_t> dominant_place;
    /// Of what its true effects add to the gap, in squares, the share that the explanation removes. What the
    /// true effects leave is the gap that the discrepancy makes alone.
    std::optional<double> removed_of_true;
    /// Of a case whose effect is a formula that no name is right for.
    std::optional<EquationScore> equation;
    bool proposes_equation = false;
};

/// Of a case with an effect withheld, or with one that the catalogue lacks, every name is wrong.
/// @param evidence  that was diagnosed; nullptr: equations are not scored
Score score(const Label& label, const gap::Diagnosis& diagnosis, const gap::Evidence* evidence = nullptr);

}  // namespace fidservo::selfcheck
