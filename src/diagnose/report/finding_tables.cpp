// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/finding_tables.h"

#include "plant/effects/catalogue.h"
#include "src/diagnose/advice.h"
#include "src/diagnose/words.h"
#include "src/report/html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using report::escaped;

/// A value to the digit that its standard deviation makes meaningful.
std::string value_and_std(double value, double std) {
    constexpr int most_digits = 7;
    if (!std::isfinite(std) || std <= 0.0) return three_digits(value) + " \u00b1 \u2013";
    const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(std))), 0, most_digits);
    return fmt::format("{} \u00b1 {}", report::number(value, digits), report::number(std, digits));
}

std::string bar_cell(double share, const std::string& words, std::string_view kind) {
    return fmt::format(
        "<td class=\"n\">{}</td><td class=\"bar\"><span class=\"{}\" style=\"width:{:.1f}%\"></span></td>",
        escaped(words), kind, 100.0 * std::clamp(share, 0.0, 1.0));
}

std::string parameters_html(const gap::FoundEffect& found, const plant::Effect* effect) {
    std::string html =
        "<table class=\"data\"><thead><tr><th>Parameter</th><th class=\"n\">Value \u00b1 "
        "std</th><th>Unit</th><th>Meaning</th></tr></thead><tbody>";
    for (const gap::FittedParameter& parameter : found.parameters) {
        std::string_view meaning;
        if (effect != nullptr)
            for (const plant::EffectParameter& stated : effect->parameters)
                if (stated.name == parameter.name) meaning = stated.meaning;
        html +=
            fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td>{}</td><td class=\"wide\">{}</td></tr>",
                        escaped(parameter.name), value_and_std(parameter.value, parameter.std),
                        escaped(parameter.unit), escaped(meaning));
    }
    return html + "</tbody></table>\n";
}

/// How to check that it is one of the effects that the recordings cannot tell apart.
std::string alternatives_html(const std::vector<std::string>& names) {
    if (names.empty()) return "";
    std::string html = "<p>These recordings cannot tell it from:</p><ul>";
    for (const std::string& name : names) {
        const Advice* advice = advice_on(name);
        html += fmt::format("<li><strong>{}</strong>", escaped(readable(name)));
        if (advice != nullptr) html += fmt::format(": {}. {}", escaped(advice->what), escaped(advice->check));
        html += "</li>";
    }
    return html + "</ul>";
}

std::string advice_html(const Advice* advice) {
    if (advice == nullptr) return "";
    return fmt::format(
        "<dl class=\"advice\"><dt>How to check</dt><dd>{}</dd><dt>How to cure</dt><dd>{}</dd></dl>\n",
        escaped(advice->check), escaped(advice->cure));
}

std::string found_effect_html(const gap::FoundEffect& found, const gap::Diagnosis& diagnosis) {
    const auto setting =
        std::ranges::find(diagnosis.hypothesis, found.effect,
                          [](const plant::EffectSetting& named) { return named.effect->name; });
    const plant::Effect* effect = setting == diagnosis.hypothesis.end() ? nullptr : setting->effect;
    const Advice* advice = advice_on(found.effect);
    std::string html = fmt::format(
        "<article class=\"card finding\"><h3>{}</h3>\n<p class=\"remark\">in {} ({}) \u00b7 probability {} "
        "\u00b7 gap removed with it and those before it: {} (95 %: {} to {})</p>\n",
        escaped(capitalised(readable(found.effect))), block_words(found.block), escaped(found.block),
        escaped(probability_words(found.probability)), escaped(share_words(found.gap_removed)),
        escaped(share_words(found.gap_removed_low)), escaped(share_words(found.gap_removed_high)));
    if (advice != nullptr)
        html += fmt::format("<p>{}.</p>\n", escaped(capitalised(std::string(advice->what))));
    html +=
        advice_html(advice) + parameters_html(found, effect) + alternatives_html(ties_of(found, diagnosis));
    if (effect != nullptr)
        html += fmt::format(
            "<details><summary>The model</summary><p>{}</p><p class=\"remark\">{}</p></details>\n",
            escaped(effect->text), escaped(effect->source));
    return html + "</article>\n";
}

std::string candidate_rows(std::span<const gap::TriedEffect> tried, const gap::Diagnosis& diagnosis) {
    std::string html;
    for (const gap::TriedEffect& candidate : tried) {
        const bool is_found = std::ranges::find(diagnosis.effects, candidate.effect,
                                                &gap::FoundEffect::effect) != diagnosis.effects.end();
        html += fmt::format(
            "<tr{}><td>{}</td><td>{}</td>{}{}</tr>\n", is_found ? " class=\"found\"" : "",
            escaped(readable(candidate.effect)), escaped(candidate.block),
            bar_cell(candidate.probability, probability_words(candidate.probability), "probability"),
            bar_cell(candidate.gap_removed, share_words(candidate.gap_removed), "removal"));
    }
    return html;
}

}  // namespace

std::string found_effects_html(const gap::Diagnosis& diagnosis) {
    std::string html;
    for (const gap::FoundEffect& effect : diagnosis.effects) html += found_effect_html(effect, diagnosis);
    return html;
}

std::string candidates_html(const gap::Diagnosis& diagnosis) {
    if (diagnosis.candidates.empty())
        return "<p>No effect of the catalogue could be tried on these recordings.</p>\n";
    constexpr std::size_t shown = 12;
    constexpr const char* head =
        "<table class=\"candidates\"><thead><tr><th>Effect</th><th>Block</th><th "
        "class=\"n\">Probability</th><th></th><th class=\"n\">Gap "
        "removed</th><th></th></tr></thead><tbody>\n";
    const std::span<const gap::TriedEffect> all(diagnosis.candidates);
    const std::size_t first = std::min(shown, all.size());
    std::string html = fmt::format("<div class=\"scroll\">{}{}</tbody></table></div>\n", head,
                                   candidate_rows(all.first(first), diagnosis));
    if (first < all.size())
        html += fmt::format(
            "<details><summary>{} more, less likely</summary><div "
            "class=\"scroll\">{}{}</tbody></table></div></details>\n",
            all.size() - first, head, candidate_rows(all.subspan(first), diagnosis));
    return html +
           "<p class=\"remark\">Each alone, before any other effect was taken in: its probability against "
           "all others and against no effect, and the share of the gap that it removes on held-out "
           "recordings; 0 % also stands for an effect that a first look dismissed. Effects that were taken "
           "into the explanation are printed bold; one that acts beside a larger one can look small "
           "here.</p>\n";
}

}  // namespace fidservo::diagnose
