// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/report.h"

#include "core/rig.h"
#include "src/diagnose/report/chain_drawing.h"
#include "src/diagnose/report/dependence_charts.h"
#include "src/diagnose/report/designed_experiment_plots.h"
#include "src/diagnose/report/finding_tables.h"
#include "src/diagnose/report/predictions.h"
#include "src/diagnose/report/recording_gaps.h"
#include "src/diagnose/report/traces.h"
#include "src/diagnose/report/waterfall.h"
#include "src/diagnose/verdict_words.h"
#include "src/diagnose/words.h"
#include "src/process/commit.h"
#include "src/report/html.h"
#include "src/report/page.h"

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using report::escaped;
using report::Mood;

Mood mood_of(gap::Verdict verdict) {
    switch (verdict) {
        case gap::Verdict::no_gap:
            return Mood::good;
        case gap::Verdict::explained:
            return Mood::neutral;
        case gap::Verdict::partly_explained:
            return Mood::unsure;
        case gap::Verdict::unexplained:
            return Mood::bad;
    }
    return Mood::neutral;
}

Mood mood_of_gap(double floors) {
    const int size = size_class(floors);
    return size == 0 ? Mood::good : size == 1 ? Mood::unsure : Mood::bad;
}

std::vector<report::KeyFigure> figures_of(const gap::Diagnosis& diagnosis) {
    std::vector<report::KeyFigure> figures{
        {readable(gap::name_of(diagnosis.verdict)), "verdict", mood_of(diagnosis.verdict)},
        {three_digits(diagnosis.gap.before), diagnosis.effects.empty() ? "gap, floors" : "gap before, floors",
         mood_of_gap(diagnosis.gap.before)}};
    if (!diagnosis.effects.empty()) {
        figures.push_back(
            {three_digits(diagnosis.gap.after), "gap after, floors", mood_of_gap(diagnosis.gap.after)});
        figures.push_back({share_words(diagnosis.gap.removed()), "of the gap removed"});
    }
    if (!diagnosis.where.empty()) {
        const gap::BlockProbability& first = diagnosis.where.front();
        figures.push_back({first.block, "where, probability " + probability_words(first.probability)});
    }
    return figures;
}

std::string chain_html(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis) {
    std::string hint =
        "Rounded boxes are what was measured: between two of them the simulator is fed with what was "
        "recorded at the first and predicts what was recorded at the second. fl: noise floors, the error "
        "that sensor noise and rounding make by themselves. Framed blocks are where the gap arises, with the "
        "probability.";
    if (evidence.rig().micro)
        hint += fmt::format(" 1 LSB of the Hall reading is {} of the platform in the middle of its range.",
                            platform_motion(evidence.rig(), 1.0));
    return chain_drawing_svg(evidence.rig(), diagnosis) +
           "<p class=\"legend sizes\"><span class=\"size-0\">at the noise floor</span><span "
           "class=\"size-1\">up to 2 floors</span><span class=\"size-2\">up to 5</span><span "
           "class=\"size-3\">up to 20</span><span class=\"size-4\">more</span></p>\n<p class=\"remark\">" +
           hint + "</p>\n";
}

std::string subline_of(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis) {
    double duration_s = 0.0;
    for (const Recording& recording : evidence.recordings())
        duration_s += static_cast<double>(recording.rows.size()) * recording.tick_s;
    const std::string end =
        diagnosis.ended == gap::Ended::finished ? "" : " " + capitalised(end_words(diagnosis.ended)) + ".";
    return fmt::format("{}{} Rig {}, {} recording{}, {:.0f} s.", verdict_detail(diagnosis), end,
                       evidence.rig().name, evidence.recordings().size(),
                       evidence.recordings().size() == 1 ? "" : "s", duration_s);
}

std::string method_html(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis) {
    std::string rows;
    for (const gap::SignalGap& signal : diagnosis.signals)
        rows += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
            "class=\"n\">{}</td></tr>\n",
            escaped(capitalised(std::string(signal_words(signal.signal)))),
            escaped(shown_size(evidence.rig(), signal.signal, signal.before)),
            escaped(shown_size(evidence.rig(), signal.signal, signal.after)),
            escaped(shown_size(evidence.rig(), signal.signal, signal.discrepancy)),
            escaped(shown_size(evidence.rig(), signal.signal, signal.floor)));
    return fmt::format(
               "<div class=\"scroll\"><table class=\"data\"><thead><tr><th>Signal</th><th "
               "class=\"n\">Before</th><th class=\"n\">After</th><th class=\"n\">Unexplained</th><th "
               "class=\"n\">Floor</th></tr></thead><tbody>\n{}</tbody></table></div>\n",
               rows) +
           "<p class=\"caption\">R.m.s. of prediction minus recording on windows of 1 s, each begun from the "
           "100 ms before it, on recordings that the parameters were not fitted to. Unexplained is what "
           "noise "
           "does not account for of what is left. The floor of a signal is "
           "its noise at rest and its rounding step, root of the sum of squares; that of a controller's "
           "command is set to 0.1 mV or the file's digits. The total gap is the r.m.s. of the signals' "
           "errors in floors; removed = 1 \u2212 (after\u00b2 \u2212 1) / (before\u00b2 \u2212 1).</p>\n";
}

std::string footer_html(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                        const Request& request) {
    std::string html = fmt::format(
        "<table><tr><td>Program</td><td>fidservo {}</td></tr><tr><td>Rig</td><td>{} "
        "(<code>{}</code>)</td></tr>",
        program_version(), escaped(evidence.rig().name), escaped(request.rig_file.string()));
    for (const plant::EffectSetting& setting : diagnosis.hypothesis) {
        std::string values;
        for (std::size_t k = 0; k < setting.values.size(); ++k)
            values += fmt::format("{}{}={:.6g}", k == 0 ? ":" : ",", setting.effect->parameters[k].name,
                                  setting.values[k]);
        html += fmt::format("<tr><td>Found</td><td><code>--effect {}{}</code></td></tr>",
                            escaped(setting.effect->name), escaped(values));
    }
    return html + "</table>";
}

}  // namespace

std::string diagnosis_report(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                             const Request& request) {
    const Predictions predictions = predict(evidence, diagnosis.hypothesis);
    report::Page page;
    page.title = evidence.rig().name + " \u2013 diagnosis";
    page.kind = "Diagnosis of the gap between rig and simulator \u00b7 " + evidence.rig().name;
    page.headline = verdict_sentence(diagnosis);
    page.subline = subline_of(evidence, diagnosis);
    page.mood = diagnosis.signals.empty() ? Mood::unsure : mood_of(diagnosis.verdict);
    if (!diagnosis.signals.empty()) page.figures = figures_of(diagnosis);
    page.body = report::section("chain", "Where the gap is", chain_html(evidence, diagnosis));
    if (!diagnosis.effects.empty()) {
        page.body += report::section("waterfall", "How the gap closes", waterfall_svg(diagnosis));
        page.body += report::section("found", "What was found", found_effects_html(diagnosis));
    }
    page.body +=
        report::section("next", "What to do next", next_steps_html(diagnosis, evidence.rig(), request));
    if (request.designed)
        page.body += report::section("experiment", "The designed experiment",
                                     designed_experiment_html(evidence.rig(), *request.designed));
    if (!diagnosis.signals.empty())
        page.body += report::section("traces", "Recorded and predicted", traces_html(evidence, predictions));
    const std::string dependence = dependence_html(evidence, diagnosis, predictions);
    if (!dependence.empty())
        page.body += report::section("dependence", "What the error depends on", dependence);
    page.body += report::section("candidates", "What was tried", candidates_html(diagnosis));
    page.body += report::section("recordings", "The recordings", recording_gaps_html(evidence, predictions));
    if (!diagnosis.signals.empty())
        page.body += report::section("method", "How the gap is counted", method_html(evidence, diagnosis));
    page.footer = footer_html(evidence, diagnosis, request);
    return report::render(page);
}

}  // namespace fidservo::diagnose
