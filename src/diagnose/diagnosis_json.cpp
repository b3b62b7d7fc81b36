// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/diagnosis_json.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/diagnose/verdict_words.h"
#include "src/files/rig/rig_edit.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace fidservo {
namespace {

using Json = nlohmann::ordered_json;

/// Six digits: more would be noise.
Json number(double value) {
    if (!std::isfinite(value)) return nullptr;
    return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);  // unlike stod, takes what is nearly 0
}

Json json_of(const std::vector<gap::FittedParameter>& fitted) {
    Json parameters = Json::array();
    for (const gap::FittedParameter& parameter : fitted)
        parameters.push_back({{"name", parameter.name},
                              {"value", number(parameter.value)},
                              {"unit", parameter.unit},
                              {"std", number(parameter.std)}});
    return parameters;
}

Json json_of(const gap::FoundEffect& effect) {
    return {{"effect", effect.effect},
            {"block", effect.block},
            {"probability", number(effect.probability)},
            {"support", support_json(effect.support)},
            {"parameters", json_of(effect.parameters)},
            {"indistinguishable_from", effect.indistinguishable_from},
            {"gap_removed", number(effect.gap_removed)},
            {"gap_removed_interval", {number(effect.gap_removed_low), number(effect.gap_removed_high)}}};
}

Json json_of(const std::optional<gap::Equation>& equation) {
    if (!equation) return nullptr;
    return {{"acts_on", equation->acts_on},
            {"formula", equation->formula},
            {"variables", equation->variables},
            {"parameters", json_of(equation->parameters)},
            {"gap_removed", number(equation->gap_removed)},
            {"gap_removed_interval", {number(equation->gap_removed_low), number(equation->gap_removed_high)}},
            {"gap_removed_of_kinds_left_out",
             number(equation->gap_removed_of_kinds_left_out.value_or(std::nan("")))},
            {"text", equation->text},
            {"in_place_of_names", equation->in_place_of_names}};
}

Json json_of(const std::optional<gap::Remainder>& remainder) {
    if (!remainder) return nullptr;
    return {{"block", remainder->block},
            {"depends_on", remainder->depends_on},
            {"text", remainder->text},
            {"equation", json_of(remainder->equation)}};
}

Json json_of(const std::optional<gap::ProposedExperiment>& proposed) {
    if (!proposed) return nullptr;
    return {
        {"experiment", proposed->experiment}, {"separates", proposed->separates}, {"text", proposed->text}};
}

std::string described(const gap::FittedParameter& parameter) {
    const std::string uncertain =
        std::isfinite(parameter.std) ? fmt::format("+- {:.2g}", parameter.std) : "+- not known";
    return fmt::format("    {} = {:.6g} {} {}\n", parameter.name, parameter.value, uncertain, parameter.unit);
}

std::string described(const gap::FoundEffect& effect) {
    std::string text =
        fmt::format("  {} ({}), probability {:.2f}, gap removed so far {:.1f} %\n", effect.effect,
                    effect.block, effect.probability, 100.0 * effect.gap_removed);
    for (const gap::FittedParameter& parameter : effect.parameters) text += described(parameter);
    if (!effect.indistinguishable_from.empty())
        text += fmt::format("    these data cannot tell it from: {}\n",
                            fmt::join(effect.indistinguishable_from, ", "));
    return text;
}

std::string described(const gap::Equation& equation) {
    std::string text = fmt::format(
        "equation{}: {} added at {}, removes {:.1f} % of {} ({:.1f} to {:.1f} %)\n",
        equation.in_place_of_names ? " in place of these names" : "", equation.formula, equation.acts_on,
        100.0 * equation.gap_removed, equation.in_place_of_names ? "the gap" : "what is left",
        100.0 * equation.gap_removed_low, 100.0 * equation.gap_removed_high);
    if (equation.gap_removed_of_kinds_left_out)
        text += fmt::format("    of experiments of a kind that it was not fitted to {:.1f} %\n",
                            100.0 * *equation.gap_removed_of_kinds_left_out);
    for (const gap::FittedParameter& parameter : equation.parameters) text += described(parameter);
    return text;
}

}  // namespace

nlohmann::ordered_json support_json(const gap::Support& support) {
    return {{"weight", number(support.weight)},
            {"left_floors", number(support.left_floors)},
            {"without_floors", number(support.without_floors)},
            {"gap_alone", number(support.gap_alone)},
            {"gap_after", number(support.gap_after)},
            {"gap_left", number(support.gap_left)},
            {"names", support.names},
            {"halves_apart", number(support.halves_apart)},
            {"at_bound", support.is_at_bound},
            {"leaves_something", support.leaves_something},
            {"leaves_dependence", support.leaves_dependence},
            {"contested", support.is_contested}};
}

std::string diagnosis_json(const gap::Diagnosis& diagnosis) {
    Json signals = Json::array(), where = Json::array(), effects = Json::array(), tried = Json::array();
    for (const gap::SignalGap& signal : diagnosis.signals)
        signals.push_back({{"signal", gap::name_of(signal.signal)},
                           {"unit", gap::unit_of(signal.signal)},
                           {"before", number(signal.before)},
                           {"after", number(signal.after)},
                           {"discrepancy", number(signal.discrepancy)},
                           {"floor", number(signal.floor)}});
    for (const gap::BlockProbability& block : diagnosis.where)
        where.push_back({{"block", block.block}, {"probability", number(block.probability)}});
    for (const gap::FoundEffect& effect : diagnosis.effects) effects.push_back(json_of(effect));
    for (const gap::TriedEffect& effect : diagnosis.candidates)
        tried.push_back({{"effect", effect.effect},
                         {"probability", number(effect.probability)},
                         {"gap_removed", number(effect.gap_removed)},
                         {"would_show", effect.would_show}});
    const Json all{{"format", "fidservo-diagnosis/1"},
                   {"verdict", gap::name_of(diagnosis.verdict)},
                   {"ended", gap::name_of(diagnosis.ended)},
                   {"signals", signals},
                   {"where", where},
                   {"effects", effects},
                   {"candidates", tried},
                   {"gap",
                    {{"before", number(diagnosis.gap.before)},
                     {"after", number(diagnosis.gap.after)},
                     {"floor", 1.0},
                     {"removed", number(diagnosis.gap.removed())}}},
                   {"unexplained", json_of(diagnosis.unexplained)},
                   {"next_experiment", json_of(diagnosis.next_experiment)},
                   {"notes", diagnosis.notes}};
    return all.dump(2) + "\n";
}

std::string describe(const gap::Diagnosis& diagnosis) {
    std::string text = fmt::format("verdict: {}\n", gap::name_of(diagnosis.verdict));
    if (diagnosis.ended != gap::Ended::finished)
        text += fmt::format("ended: {}\n", diagnose::end_words(diagnosis.ended));
    text +=
        fmt::format("gap: {:.3g} floors before, {:.4g} after\n", diagnosis.gap.before, diagnosis.gap.after);
    for (const gap::SignalGap& signal : diagnosis.signals)
        text += fmt::format("  {:<14} {:>9.4g} -> {:>8.4g} {} (floor {:.3g}; {:.3g} unexplained)\n",
                            gap::name_of(signal.signal), signal.before, signal.after,
                            gap::unit_of(signal.signal), signal.floor, signal.discrepancy);
    for (const gap::FoundEffect& effect : diagnosis.effects) text += described(effect);
    if (diagnosis.unexplained) {
        text += "unexplained: " + diagnosis.unexplained->text + "\n";
        if (diagnosis.unexplained->equation) text += described(*diagnosis.unexplained->equation);
    }
    if (diagnosis.next_experiment) text += "next: " + diagnosis.next_experiment->text + "\n";
    for (const std::string& note : diagnosis.notes) text += "note: " + note + "\n";
    return text;
}

void write_diagnosed_rig(const std::filesystem::path& file, const std::filesystem::path& source,
                         const gap::Diagnosis& diagnosis) {
    RigEdit edit(source);
    std::vector<plant::EffectSetting> settings = diagnosis.hypothesis;
    if (const gap::Equation* equation = gap::proposed_equation(diagnosis)) {
        if (equation->in_place_of_names) settings.clear();
        settings.push_back(equation->setting);
    }
    for (const plant::EffectSetting& setting : settings) edit.add_effect(plant::stated(setting));
    edit.save(file);
}

}  // namespace fidservo
