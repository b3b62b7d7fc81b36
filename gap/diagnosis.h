#pragma once
// What a diagnosis says: the fields of the file that `diagnose --json` writes, and what its report draws.
#include "gap/evidence.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::gap {

enum class Verdict { no_gap, explained, partly_explained, unexplained };
std::string_view name_of(Verdict verdict);

/// A size for each signal, in its unit.
using SignalLimits = std::array<double, signal_count>;

/// R.m.s. over held-out windows, in the signal's unit.
struct SignalGap {
    Signal signal;
    double before, after, floor;
    double discrepancy = 0.0;  ///< of `after`, what no named effect explains: beyond what noise leaves
};

struct BlockProbability {
    std::string block;
    double probability;
};

struct FittedParameter {
    std::string name, unit;
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
    std::string effect, block;
    double probability;
    Support support = {};
    std::vector<FittedParameter> parameters;
    std::vector<std::string> indistinguishable_from;
    /// Of these, as fitted, what other recordings could tell from it.
    std::vector<plant::EffectSetting> rivals = {};
    double gap_removed;  ///< with this one and those before it
    double gap_removed_low, gap_removed_high;
};

/// An effect that was tried alone.
struct TriedEffect {
    std::string effect, block;
    double probability;
    double gap_removed;
};

/// R.m.s. over the signals of (error / floor), held-out windows.
struct TotalGap {
    double before, after;
    double removed() const;  ///< 1 - (after^2 - 1) / (before^2 - 1), clipped to 0 .. 1
};

/// A formula that is proposed for what no named effect explains (gap/equation/equation.h).
struct Equation {
    std::string acts_on;                 ///< the port
    std::string formula;                 ///< in the port's unit
    std::vector<std::string> variables;  ///< of the port, that it depends on
    std::vector<FittedParameter> parameters;
    double gap_removed;  ///< of what is left without it
    double gap_removed_low, gap_removed_high;
    /// The same where each kind of experiment is predicted from the others; empty where there is one kind.
    std::optional<double> gap_removed_of_kinds_left_out = {};
    std::string text;  ///< in words
    plant::EffectSetting setting;
    /// Of the whole gap rather than of what the named effects leave, which are not credible.
    bool in_place_of_names = false;
};

struct Remainder {
    std::string block;
    std::vector<std::string> depends_on;
    std::string text;
    std::optional<Equation> equation = {};
};

struct ProposedExperiment {
    std::string experiment;
    std::vector<std::string> separates;
    std::string text;
};

struct Diagnosis {
    Verdict verdict = Verdict::no_gap;
    std::vector<SignalGap> signals;
    std::vector<BlockProbability> where;  ///< most likely first
    std::vector<FoundEffect> effects;     ///< that first which alone would make the largest gap
    std::vector<TriedEffect> candidates;  ///< most likely first
    TotalGap gap{1.0, 1.0};
    std::optional<Remainder> unexplained;
    std::optional<ProposedExperiment> next_experiment;
    Ended ended = Ended::finished;   ///< otherwise this is the best that was found until then
    Hypothesis hypothesis;           ///< all effects with the values fitted to all recordings
    std::vector<std::string> notes;  ///< what could not be decided, and why
};

/// What is proposed for what no named effect explains; nullptr: nothing is.
const Equation* proposed_equation(const Diagnosis& diagnosis);

}  // namespace fidservo::gap
