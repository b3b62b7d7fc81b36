// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The result of a diagnosis: the fields of the file that `diagnose --json` writes and of its report.
#include "gap/evidence.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::gap {

/// The result in a word.
enum class Verdict {
    no_gap,            ///< no effect improves the prediction of held-out data
    explained,         ///< with the effects found no relevant gap remains
    partly_explained,  ///< with the effects found a gap remains
    unexplained,       ///< there is a gap, and no effect of the catalogue explains it
};
/// The name in files.
std::string_view name_of(Verdict verdict);
/// Whether a gap remains.
bool is_gap_left(Verdict verdict);

/// A size for each signal, in the signal's unit.
using SignalLimits = std::array<double, signal_count>;

/// R.m.s. prediction error of a signal over held-out windows, in the signal's unit.
struct SignalGap {
    Signal signal;  ///< which
    /// Without effects, with the effects found, and as expected from noise for a perfect model.
    double before, after, floor;
    double discrepancy = 0.0;  ///< the part of `after` beyond noise, which no named effect explains
};

/// The probability that the rig file is wrong in a block.
struct BlockProbability {
    std::string block;   ///< macro.friction, micro.heater and the like
    double probability;  ///< 0 to 1
};

/// A fitted parameter of an effect.
struct FittedParameter {
    /// As in the catalogue.
    std::string name, unit;
    /// In the unit `unit`; std is one standard error.
    double value, std;
};

/// The evidence for a named effect.
struct Support {
    /// Total weight, among the alternative explanations that were tried, of those with this effect or with
    /// one that these recordings cannot distinguish from it (gap/verdict/model_weights.h).
    double weight = 0.0;
    /// Remaining prediction error, in floors, of the signal that determines the effect and in which it
    /// matters most (typical_floors).
    double left_floors = 1.0;
    double without_floors = 1.0;  ///< the same without the effect
    /// Prediction error, in floors, that the effect alone causes relative to the rig file.
    double gap_alone = 1.0;
    double gap_after = 1.0;  ///< total gap that remains with all named effects, in floors
    double gap_left = 0.0;   ///< fraction of the total gap that remains with all named effects
    double names = 1.0;      ///< number of effects named
    /// Difference of the effect's sizes between fits to the two halves of the windows, relative to their
    /// mean; 1 if the time did not suffice to fit the halves separately.
    double halves_apart = 0.0;
    /// Whether a size is at a bound, or a shape at the largest value that is tried.
    bool is_at_bound = false;
    /// Whether a signal that determines the effect stays off its floor.
    bool leaves_something = false;
    /// Whether residual analysis finds a quantity on which the remaining errors of such a signal depend.
    bool leaves_dependence = false;
    /// For an effect of the camera, of what it sees, or of the encoder's reading: whether residual analysis
    /// of the whole gap, without any named effect, finds a single quantity on which it depends, and thereby a
    /// block of camera or plate to which no named effect belongs.
    bool is_contested = false;
};

/// An effect in the explanation.
struct FoundEffect {
    /// As in the catalogue.
    std::string effect, block;
    double probability;                       ///< of the effect's being present, 0 to 1
    Support support = {};                     ///< the evidence for it
    std::vector<FittedParameter> parameters;  ///< as fitted
    /// Effects that these recordings cannot distinguish from it.
    std::vector<std::string> indistinguishable_from;
    /// Those effects, as fitted, that other recordings could distinguish from it.
    std::vector<plant::EffectSetting> rivals = {};
    double gap_removed;  ///< fraction of the gap that is removed with this effect and those before it
    /// Limits of its 95 % interval.
    double gap_removed_low, gap_removed_high;
};

/// An effect that was tried alone.
struct TriedEffect {
    /// As in the catalogue.
    std::string effect, block;
    double probability;  ///< of the effect's being present, 0 to 1
    double gap_removed;  ///< fraction of the gap that it alone removes
    /// Whether the effect would show in these recordings at its typical size; if not, they give no
    /// information on it.
    bool would_show = true;
};

/// R.m.s. over all signals of error / floor, on held-out windows.
struct TotalGap {
    /// Without effects, and with the effects found.
    double before, after;
    double removed() const;  ///< 1 - (after^2 - 1) / (before^2 - 1), clipped to 0 .. 1
};

/// A formula that is proposed for what no named effect explains (gap/equation/equation.h).
struct Equation {
    std::string acts_on;                      ///< the port at which the formula acts
    std::string formula;                      ///< in the port's unit
    std::vector<std::string> variables;       ///< the port's variables on which it depends
    std::vector<FittedParameter> parameters;  ///< its coefficients and shapes as fitted
    double gap_removed;                       ///< fraction of the gap without it that it removes
    /// Limits of its 95 % interval.
    double gap_removed_low, gap_removed_high;
    /// gap_removed where each kind of experiment is predicted from the other kinds; empty if there is only
    /// one kind.
    std::optional<double> gap_removed_of_kinds_left_out = {};
    std::string text;              ///< in words
    plant::EffectSetting setting;  ///< the formula as an effect, ready to be simulated
    /// Whether the formula explains the whole gap in place of the named effects, because it predicts better
    /// than they do.
    bool in_place_of_names = false;
};

/// What no named effect explains.
struct Remainder {
    std::string block;                      ///< the block that it is attributed to
    std::vector<std::string> depends_on;    ///< the quantities on which it depends
    std::string text;                       ///< in words
    std::optional<Equation> equation = {};  ///< a formula for it, where one was found
    std::optional<Signal> signal = {};      ///< the signal whose error was analysed
};

/// The experiment that would be most informative.
struct ProposedExperiment {
    std::string experiment;              ///< its name
    std::vector<std::string> separates;  ///< effects that it would distinguish
    std::string text;                    ///< in words
};

/// The whole result of a diagnosis.
struct Diagnosis {
    Verdict verdict = Verdict::no_gap;    ///< the result in a word
    std::vector<SignalGap> signals;       ///< for each signal
    std::vector<BlockProbability> where;  ///< probable blocks, the most likely first
    std::vector<FoundEffect> effects;  ///< ordered by the gap that each alone would cause, the largest first
    std::vector<TriedEffect> candidates;                ///< most likely first
    TotalGap gap{1.0, 1.0};                             ///< total over all signals
    std::optional<Remainder> unexplained;               ///< what remains; empty: nothing relevant
    std::optional<ProposedExperiment> next_experiment;  ///< empty: no experiment would give more information
    Ended ended = Ended::finished;   ///< if not finished, the result is the best until then
    Hypothesis hypothesis;           ///< the effects named, with values fitted to all recordings
    std::vector<std::string> notes;  ///< what could not be decided, and why
};

/// The formula that is proposed for what no named effect explains; nullptr: none is.
const Equation* proposed_equation(const Diagnosis& diagnosis);

}  // namespace fidservo::gap
