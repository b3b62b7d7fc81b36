// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compare/comparison.h"
#include "src/diagnose/diagnosis_json.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace fidservo::compare {

std::string describe(const Comparison& comparison) {
    std::string text =
        comparison.has_changed() ? "the rig has changed\n" : "nothing has changed significantly\n";
    text += fmt::format("B is predicted with what A taught to {:.3g} floors, with its own values to {:.3g}\n",
                        comparison.gap_by_before, comparison.gap_by_own);
    for (const ParameterPair& pair : comparison.shared)
        text += fmt::format(
            "  {} ({}) {}: {:.5g} +- {:.2g} -> {:.5g} +- {:.2g} {}, difference {:.3g} +- {:.2g} (95 %), p = "
            "{:.2g}: {}\n",
            pair.effect, pair.block, pair.parameter, pair.before, pair.before_std, pair.after, pair.after_std,
            pair.unit, pair.after - pair.before, 1.96 * std::hypot(pair.before_std, pair.after_std), pair.p,
            pair.has_changed ? "changed" : "the same");
    const bool has_news = comparison.has_news();
    for (const gap::FoundEffect& effect : comparison.beyond.effects) {
        if (!has_news) break;
        text += fmt::format("  {} ({}): new in B, probability {:.2f}\n", effect.effect, effect.block,
                            effect.probability);
        if (!effect.indistinguishable_from.empty())
            text += fmt::format("    these recordings cannot tell it from: {}\n",
                                fmt::join(effect.indistinguishable_from, ", "));
        for (const gap::FittedParameter& parameter : effect.parameters)
            text += fmt::format("    {} = {:.5g} +- {:.2g} {}\n", parameter.name, parameter.value,
                                1.96 * parameter.std, parameter.unit);
    }
    if (has_news && comparison.beyond.unexplained)
        text += "  new in B, and not explained: " + comparison.beyond.unexplained->text + "\n";
    for (const std::string& note : comparison.before.notes) text += "note on A: " + note + "\n";
    for (const std::string& note : comparison.beyond.notes) text += "note on B: " + note + "\n";
    return text;
}

std::string comparison_json(const Comparison& comparison) {
    using Json = nlohmann::ordered_json;
    Json parameters = Json::array();
    for (const ParameterPair& pair : comparison.shared)
        parameters.push_back({{"effect", pair.effect},
                              {"block", pair.block},
                              {"parameter", pair.parameter},
                              {"unit", pair.unit},
                              {"a", {{"value", pair.before}, {"std", pair.before_std}}},
                              {"b", {{"value", pair.after}, {"std", pair.after_std}}},
                              {"difference", pair.after - pair.before},
                              {"difference_std", std::hypot(pair.before_std, pair.after_std)},
                              {"p", pair.p},
                              {"changed", pair.has_changed}});
    const Json all{{"format", "fidservo-comparison/1"},
                   {"changed", comparison.has_changed()},
                   {"gap_of_b", {{"by_a", comparison.gap_by_before}, {"by_own", comparison.gap_by_own}}},
                   {"parameters", parameters},
                   {"a", Json::parse(diagnosis_json(comparison.before))},
                   {"b_beyond_a", Json::parse(diagnosis_json(comparison.beyond))}};
    return all.dump(2) + "\n";
}

}  // namespace fidservo::compare
