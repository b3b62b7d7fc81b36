// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a diagnosis says: the fields of the file that `diagnose --json` writes, and what its report draws.
#include "gap/evidence.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::gap {

/// The answer in a word.
enum class Verdict {
    no_gap,            ///< no effect improves the prediction of what was held out
    explained,         ///< with the effects found nothing is left that counts
    partly_explained,  ///< with the effects found something is left
    unexplained,       ///< there is a gap, and no listed effect explains it
};
/// As files have it.
std::string_view name_of(Verdict verdict);

/// A size for each signal, in its unit.
using SignalLimits = std::array<double, signal_count>;

/// R.m.s. over held-out windows, in the signal's unit.
struct SignalGap {
    Signal signal;  ///< which
    /// Without effects, with those found, and under the truth.
    double before, after, floor;
    double discrepancy = 0.0;  ///< of `after`, what no named effect explains: beyond what noise leaves
};

/// How likely a part of the rig is what the file has wrong.
struct BlockProbability {
    std::string block;   ///< macro.friction, micro.heater and the like
    double probability;  ///< 0 to 1
};

/// A number of an effect as fitted.
struct FittedParameter {
    /// By the catalogue.
    std::string name, unit;
    /// In its unit; one standard error.
    double value, std;
};

/// What speaks for a name.
struct Support {
    /// Of the explanations that were tried in its place, the weight of those that have it, or what these
    /// recordings cannot tell from it (gap/verdict/model_weights.h).
    double weight = 0.0;
    /// What is left of that of the signals which teach it in which it matters most (typical_floors).
    double left_floors = 1.0;
    double without_floors = 1.0;  ///< the same without it
    double gap_alone = 1.0;       ///< the gap that it alone would make beside the rig file, in floors
    double gap_after = 1.0;       ///< the whole gap that all names together leave, in floors
    double gap_left = 0.0;        ///< share of the whole gap that all names together leave
    double names = 1.0;           ///< how many effects are named
    /// Whether the whole gap, analysed without names, accuses a block that is named: 1; whether it depends on
    /// one thing alone that accuses another block of the same stage, or of the view: 0; neither: 0.5.
    double agreement = 0.5;
    /// By how much its sizes differ from one half of the windows to the other, over their mean.
    double halves_apart = 0.0;
    bool is_at_bound = false;  ///< whether a value has gone as far from what is usual as it may
};

/// An effect taken into the explanation.
struct FoundEffect {
    /// By the catalogue.
    std::string effect, block;
    double probability;                               ///< that it is there, 0 to 1
    Support support = {};                             ///< what speaks for it
    std::vector<FittedParameter> parameters;          ///< as fitted
    std::vector<std::string> indistinguishable_from;  ///< effects that these recordings cannot tell from it
    /// Of these, as fitted, what other recordings could tell from it.
    std::vector<plant::EffectSetting> rivals = {};
    double gap_removed;  ///< with this one and those before it
    /// The interval at 95 %.
    double gap_removed_low, gap_removed_high;
};

/// An effect that was tried alone.
struct TriedEffect {
    /// By the catalogue.
    std::string effect, block;
    double probability;  ///< that it is there, 0 to 1
    double gap_removed;  ///< share of the gap that it alone removes
};

/// R.m.s. over the signals of (error / floor), held-out windows.
struct TotalGap {
    /// Without effects, and with those found.
    double before, after;
    double removed() const;  ///< 1 - (after^2 - 1) / (before^2 - 1), clipped to 0 .. 1
};

/// A formula that is proposed for what no named effect explains (gap/equation/equation.h).
struct Equation {
    std::string acts_on;                      ///< the port
    std::string formula;                      ///< in the port's unit
    std::vector<std::string> variables;       ///< of the port, that it depends on
    std::vector<FittedParameter> parameters;  ///< its numbers as fitted
    double gap_removed;                       ///< of what is left without it
    /// The interval at 95 %.
    double gap_removed_low, gap_removed_high;
    /// The same where each kind of experiment is predicted from the others; empty where there is one kind.
    std::optional<double> gap_removed_of_kinds_left_out = {};
    std::string text;              ///< in words
    plant::EffectSetting setting;  ///< the effect that it stands for, ready to be simulated
    /// Of the whole gap rather than of what the named effects leave, since it predicts better than they do.
    bool in_place_of_names = false;
};

/// What no named effect explains.
struct Remainder {
    std::string block;                      ///< where it is
    std::vector<std::string> depends_on;    ///< on what it depends
    std::string text;                       ///< in words
    std::optional<Equation> equation = {};  ///< a formula for it, where one was found
};

/// The experiment that would tell most.
struct ProposedExperiment {
    std::string experiment;              ///< by its name
    std::vector<std::string> separates;  ///< effects that it would tell apart
    std::string text;                    ///< in words
};

/// All that a diagnosis says.
struct Diagnosis {
    Verdict verdict = Verdict::no_gap;                  ///< in a word
    std::vector<SignalGap> signals;                     ///< signal by signal
    std::vector<BlockProbability> where;                ///< most likely first
    std::vector<FoundEffect> effects;                   ///< that first which alone would make the largest gap
    std::vector<TriedEffect> candidates;                ///< most likely first
    TotalGap gap{1.0, 1.0};                             ///< over all signals
    std::optional<Remainder> unexplained;               ///< what is left; empty: nothing that counts
    std::optional<ProposedExperiment> next_experiment;  ///< empty: none would tell more
    Ended ended = Ended::finished;   ///< otherwise this is the best that was found until then
    Hypothesis hypothesis;           ///< all effects with the values fitted to all recordings
    std::vector<std::string> notes;  ///< what could not be decided, and why
};

/// What is proposed for what no named effect explains; nullptr: nothing is.
const Equation* proposed_equation(const Diagnosis& diagnosis);

}  // namespace fidservo::gap
