#pragma once
// What a diagnosis says: the fields of the file that `diagnose --json` writes, and what its report draws.
#include "gap/evidence.h"

#include <optional>
#include <string>
#include <vector>

namespace fidservo::gap {

enum class Verdict { no_gap, explained, partly_explained, unexplained };
std::string_view name_of(Verdict verdict);

/// R.m.s. over held-out windows, in the signal's unit.
struct SignalGap {
    Signal signal;
    double before, after, floor;
};

struct BlockProbability {
    std::string block;
    double probability;
};

struct FittedParameter {
    std::string name, unit;
    double value, std;
};

/// An effect taken into the explanation.
struct FoundEffect {
    std::string effect, block;
    double probability;
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

struct Remainder {
    std::string block;
    std::vector<std::string> depends_on;
    std::string text;
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
    std::vector<FoundEffect> effects;     ///< what the rest can least do without first
    std::vector<TriedEffect> candidates;  ///< most likely first
    TotalGap gap{1.0, 1.0};
    std::optional<Remainder> unexplained;
    std::optional<ProposedExperiment> next_experiment;
    Ended ended = Ended::finished;   ///< otherwise this is the best that was found until then
    Hypothesis hypothesis;           ///< all effects with the values fitted to all recordings
    std::vector<std::string> notes;  ///< what could not be decided, and why
};

}  // namespace fidservo::gap
