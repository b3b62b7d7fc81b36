// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/fleet_page.h"

#include "src/diagnose/words.h"
#include "src/fleet/report/fleet_page_data.h"
#include "src/fleet/report/judgement_words.h"
#include "src/process/commit.h"
#include "src/report/embedded.h"
#include "src/report/html.h"
#include "src/report/page.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

using report::escaped;
using report::Mood;

std::size_t units_concerned(const FleetFindings& findings) {
    std::vector<bool> concerned(findings.units.size(), false);
    for (const Judgement& judgement : findings.judgements)
        if (judgement.whose != Whose::all || judgement.matter != Matter::deviation)
            for (const std::size_t unit : judgement.units) concerned[unit] = true;
    return static_cast<std::size_t>(std::ranges::count(concerned, true));
}

std::string judgements_sentence(const FleetFindings& findings) {
    if (findings.judgements.empty()) return nothing_stands_out(findings);
    const Judgement& first = findings.judgements.front();
    const Quantity& quantity = findings.quantities[first.quantity].quantity;
    const std::string what =
        fmt::format("{} ({})", diagnose::readable(quantity.effect), value_words(quantity, first.now));
    if (first.whose == Whose::all && first.matter == Matter::deviation)
        return fmt::format("The model is wrong for all units: {}. {} of {} units stand out besides.", what,
                           units_concerned(findings), findings.units.size());
    return fmt::format("{} of {} units stand out; first of all {}: {}.", units_concerned(findings),
                       findings.units.size(), whose_words(findings, first), what);
}

std::string headline_of(const FleetFindings& findings) {
    const std::string failed = not_diagnosed_sentence(findings.unexplained, findings.units),
                      found = findings.unexplained.empty() ? judgements_sentence(findings)
                                                           : unexplained_sentence(findings.unexplained);
    return failed.empty() ? found : failed + " " + found;
}

std::string judgement_card(const FleetFindings& findings, const Judgement& judgement) {
    std::string steps;
    for (const std::string& step : what_to_do(findings, judgement))
        if (!step.empty()) steps += fmt::format("<li>{}</li>", escaped(step));
    const std::string members = judgement.whose == Whose::group
                                    ? fmt::format("<p>{} units: {}.</p>", judgement.units.size(),
                                                  escaped(unit_names(findings, judgement.units, 24)))
                                    : "";
    const Mood mood = judgement.whose == Whose::all       ? Mood::bad
                      : judgement.matter == Matter::trend ? Mood::unsure
                                                          : Mood::neutral;
    return fmt::format(
        "<div class=\"card finding {}\"><h3>{}</h3><p>{}</p>{}<ol>{}</ol><details><summary>What speaks for "
        "it</summary><p>{}</p></details></div>\n",
        report::class_of(mood), escaped(whose_words(findings, judgement)),
        escaped(matter_sentence(findings, judgement)), members, steps,
        escaped(evidence_sentences(findings, judgement)));
}

std::string unexplained_card(const FleetFindings& findings) {
    constexpr std::size_t shown = 12;
    const Unexplained& unexplained = findings.unexplained;
    std::string units, steps;
    for (const std::string& line : unexplained_lines(unexplained, findings.units, shown))
        units += fmt::format("<li>{}</li>", escaped(line));
    for (const std::string& step : what_to_do(unexplained))
        steps += fmt::format("<li>{}</li>", escaped(step));
    return fmt::format(
        "<div class=\"card finding {}\"><h3>{}</h3><p>{}</p><ul class=\"notes\">{}</ul><ol>{}</ol></div>\n",
        report::class_of(Mood::bad), escaped(unexplained_title(unexplained, findings.units)),
        escaped(unexplained_sentence(unexplained)), units, steps);
}

std::string to_do_html(const FleetFindings& findings, const std::filesystem::path& cured) {
    constexpr std::size_t shown_at_once = 12;
    std::string html = findings.unexplained.empty() ? "" : unexplained_card(findings);
    if (!findings.unexplained.not_diagnosed.empty())
        html += fmt::format("<p>{} Why is said under What was not judged: mend that, or record again.</p>",
                            escaped(not_diagnosed_sentence(findings.unexplained, findings.units)));
    if (findings.judgements.empty())
        return html.empty() ? "<p>Nothing. Go on recording as often as until now.</p>" : html;
    if (!cured.empty())
        html += fmt::format("<p>The rig file that states what all units share: <code>{}</code></p>",
                            escaped(cured.string()));
    for (std::size_t k = 0; k < findings.judgements.size(); ++k) {
        if (k == shown_at_once)
            html += fmt::format("<details><summary>{} more</summary>", findings.judgements.size() - k);
        html += judgement_card(findings, findings.judgements[k]);
    }
    return findings.judgements.size() > shown_at_once ? html + "</details>" : html;
}

std::string heat_html() {
    return "<div class=\"plots\"><figure class=\"plot\" id=\"fleet-heat\"><p class=\"tell "
           "remark\">&nbsp;</p></figure></div>\n"
           "<p class=\"legend sizes\"><span class=\"size-0\">at the noise floor</span><span "
           "class=\"size-1\">up to 2 "
           "floors</span><span class=\"size-2\">up to 5</span><span class=\"size-3\">up to 20</span><span "
           "class=\"size-4\">more</span></p>\n<p class=\"hint\">Gap between unit and simulator, without "
           "effects. Units that "
           "stand out come first. Drag to zoom, double-click to see everything again; click a unit to follow "
           "it in all plots.</p>\n";
}

std::string effects_html(const FleetFindings& findings) {
    std::string html;
    for (std::size_t q = 0; q < findings.quantities.size(); ++q) {
        const QuantityFindings& found = findings.quantities[q];
        const Quantity& quantity = found.quantity;
        const std::string unit = quantity.unit.empty() ? "factor" : quantity.unit;
        html += fmt::format(
            "<h3>{} \u00b7 {} <span class=\"remark\">({})</span></h3><p class=\"remark\">Rig file: {}. The "
            "fleet: {}, from unit to unit "
            "\u00b1 {} floors; 1 floor is {}.</p>\n<div class=\"dependences\" data-effect=\"{}\"><figure "
            "class=\"plot plots\" "
            "id=\"effect-units-{}\"><figcaption>Units, by value <span>{}</span></figcaption><p class=\"tell "
            "remark\">&nbsp;</p></figure>"
            "<figure class=\"plot plots\" id=\"effect-time-{}\"><figcaption>Over time "
            "<span>{}</span></figcaption><p class=\"tell "
            "remark\">&nbsp;</p></figure></div>\n",
            escaped(diagnose::readable(quantity.effect)), escaped(diagnose::readable(quantity.parameter)),
            escaped(quantity.block), escaped(value_words(quantity, 0.0)),
            escaped(value_words(quantity, found.population.mean)),
            diagnose::three_digits(found.population.spread), escaped(change_words(quantity, 1.0)), q, q,
            escaped(unit), q, escaped(unit));
    }
    return html +
           "<p class=\"caption\">At the left a line a unit, 95 % by its own diagnoses, and of a unit that "
           "none of "
           "them names all that it may be without being named; the square is its value given the fleet, "
           "to which it is drawn the more the less it says itself. The band holds 95 % of units that are "
           "alike; orange is a unit with a share of its own. "
           "Dashed: the rig file, and the fleet's mean. At the right what diagnoses say; units that have "
           "changed are red, and so are "
           "the dates between which they did.</p>\n";
}

std::string changes_html(const FleetFindings& findings) {
    std::string rows;
    for (const Judgement& judgement : findings.judgements) {
        if (!judgement.since) continue;
        const Quantity& quantity = findings.quantities[judgement.quantity].quantity;
        rows += fmt::format(
            "<tr><td class=\"wide\">{}</td><td>{}</td><td>{}</td><td class=\"n\">{}{}</td><td>{}</td><td>{} "
            "\u2026 {}</td><td>{}</td></tr>\n",
            escaped(unit_names(findings, judgement.units, 6)), escaped(diagnose::readable(quantity.effect)),
            name_of(judgement.matter), escaped(change_words(quantity, judgement.size.value)),
            judgement.matter == Matter::trend ? " a week" : "", date_of(judgement.since->likeliest_s),
            date_of(judgement.since->earliest_s), date_of(judgement.since->latest_s),
            date_of(*judgement.found_s));
    }
    if (rows.empty()) return "<p>None was found.</p>";
    return "<div class=\"scroll\"><table "
           "class=\"data\"><thead><tr><th>Units</th><th>Effect</th><th>Kind</th><th class=\"n\">Change</th>"
           "<th>Since</th><th>95 %: after \u2026 by</th><th>Found</th></tr></thead><tbody>" +
           rows + "</tbody></table></div>\n";
}

std::string units_html(const std::vector<FleetResult>& results, const FleetFindings& findings) {
    std::vector<int> judgements(findings.units.size(), 0);
    for (const Judgement& judgement : findings.judgements)
        for (const std::size_t unit : judgement.units)
            judgements[unit] += judgement.whose == Whose::all ? 0 : 1;
    std::vector<bool> leaves(findings.units.size(), false);
    for (const LeftOver& left : findings.unexplained.units) leaves[left.unit] = true;
    std::string rows;
    for (std::size_t u = 0; u < findings.units.size(); ++u) {
        const UnitHistory& unit = findings.units[u];
        const FleetResult& last = results[unit.results.back()];
        std::string labels;
        for (const auto& [label, value] : last.labels)
            labels += fmt::format("{}{} {}", labels.empty() ? "" : ", ", label, value);
        rows += fmt::format(
            "<tr data-stands=\"{}\"><td>{}</td><td>{}</td><td class=\"n\">{}</td><td>{}</td><td>{}</td><td "
            "class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            judgements[u] > 0 || leaves[u] ? "out" : "in", escaped(unit.name), escaped(labels),
            unit.results.size(), last.recorded_at_s ? date_of(*last.recorded_at_s) : "\u2013",
            escaped(last.done ? diagnose::readable(last.verdict) : "failed"),
            last.done ? diagnose::three_digits(last.gap_before) : "\u2013",
            last.done ? diagnose::three_digits(last.gap_after) : "\u2013", judgements[u]);
    }
    return "<form class=\"filters\" data-table=\"units\"><input name=\"text\" placeholder=\"unit or "
           "label\"><select name=\"stands\"><option "
           "value=\"\">all</option><option value=\"out\">that stand "
           "out</option></select><output></output></form><div class=\"tall\"><table id=\"units\"><thead><tr>"
           "<th>Unit</th><th>Labels</th><th class=\"n\">Results</th><th>Last</th><th>Verdict</th><th "
           "class=\"n\">Gap, floors</th><th class=\"n\">Left, floors</th><th "
           "class=\"n\">Judgements</th></tr></thead><tbody>" +
           rows + "</tbody></table></div>\n";
}

std::string not_judged_html(const Collected& collected, const FleetFindings& findings) {
    std::string items;
    for (const std::string& line : collected.damaged) items += fmt::format("<li>{}</li>", escaped(line));
    for (const std::string& line : named_but_not_judged(collected.results))
        items += fmt::format("<li>{}</li>", escaped(line));
    std::size_t untimed = 0, other_rig = 0;
    for (const FleetResult& result : collected.results) {
        if (!result.done)
            items += fmt::format("<li>{}: {}</li>", escaped(result.campaign), escaped(result.reason));
        if (!result.recorded_at_s) untimed += 1;
    }
    for (const UnitHistory& unit : findings.units) other_rig += unit.first_judged;
    if (untimed > 0)
        items += fmt::format(
            "<li>{} results say no time (recorded_at): they count for values, not for changes</li>", untimed);
    if (other_rig > 0)
        items += fmt::format(
            "<li>{} results are of an earlier rig file of their unit: they are shown by time, and not "
            "judged</li>",
            other_rig);
    return items.empty() ? "<p>Everything was judged.</p>" : "<ul class=\"notes\">" + items + "</ul>";
}

std::string method_of_fleet(const FleetFindings& findings) {
    return fmt::format(
        "<p class=\"caption\">Sizes are counted in noise floors: 1 is what alone makes a gap as large as the "
        "noise. Changes: sum over all dates of the "
        "likelihood ratios of a step or a trend against none; an alarm where it passes {} sizes \u00d7 "
        "{:.0f} diagnoses a year / {}, without any one "
        "diagnosis, too, so that a unit raises at most {} false alarms a year, over all effects. One unit, a "
        "batch, or all: marginal likelihoods "
        "of explanations with a share for each, 19 to 1 at least after what having looked elsewhere costs. A "
        "unit's value given the fleet: normal law of units, its "
        "spread by restricted likelihood.</p>\n",
        quantities_looked_at(), findings.looks_a_year, false_alarms_a_unit_year, false_alarms_a_unit_year);
}

}  // namespace

std::string fleet_page(const std::filesystem::path& fleet, const Collected& collected,
                       const FleetFindings& findings, const std::filesystem::path& cured) {
    const std::vector<FleetResult>& results = collected.results;
    report::Page page;
    page.title = fleet.filename().string() + " \u2013 fleet";
    page.kind = "Fleet \u00b7 " + fleet.string();
    page.headline = headline_of(findings);
    page.subline = fmt::format("{}{} results of {} units.",
                               findings.unexplained.empty() ? "" : judgements_sentence(findings) + " ",
                               results.size(), findings.units.size());
    page.mood = !findings.unexplained.empty()                                               ? Mood::bad
                : findings.judgements.empty() && findings.unexplained.not_diagnosed.empty() ? Mood::good
                                                                                            : Mood::unsure;
    const auto failed =
        std::ranges::count_if(results, [](const FleetResult& result) { return !result.done; });
    const auto of = [&](Whose whose, bool changes) {
        return std::to_string(std::ranges::count_if(findings.judgements, [&](const Judgement& judgement) {
            return judgement.whose == whose && (judgement.matter != Matter::deviation) == changes;
        }));
    };
    const auto changes = std::ranges::count_if(
        findings.judgements, [](const Judgement& one) { return one.matter != Matter::deviation; });
    page.figures = {{std::to_string(findings.units.size()), "units", Mood::neutral},
                    {std::to_string(findings.unexplained.units.size()), "unexplained", Mood::bad},
                    {std::to_string(units_concerned(findings)), "stand out", Mood::unsure},
                    {of(Whose::all, false), "wrong in the model", Mood::bad},
                    {of(Whose::group, false), "of a batch", Mood::unsure},
                    {of(Whose::unit, false), "of one unit", Mood::unsure},
                    {std::to_string(changes), "changes", Mood::unsure},
                    {std::to_string(static_cast<std::size_t>(failed) + collected.damaged.size()),
                     "not judged", Mood::neutral}};
    page.body = report::section("todo", "What to do", to_do_html(findings, cured)) +
                report::section("heat", "Units by time", heat_html()) +
                report::section("changes", "What has changed", changes_html(findings)) +
                report::section("effects", "Effects over units and time", effects_html(findings)) +
                report::section("units-table", "Units", units_html(results, findings)) +
                report::section("left-out", "What was not judged", not_judged_html(collected, findings)) +
                report::section("method", "How it is judged", method_of_fleet(findings));
    page.body += "<script type=\"application/json\" id=\"fleet-data\">" + plot_data(results, findings) +
                 "</script>\n<script>";
    page.body.append(embedded::fleet_js()).append("</script>\n");
    page.footer =
        fmt::format("<table><tr><td>Program</td><td>fidservo {}</td></tr></table>", program_version());
    return report::render(page);
}

}  // namespace fidservo::fleet
