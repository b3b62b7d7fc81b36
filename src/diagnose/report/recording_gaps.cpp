// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/recording_gaps.h"

#include "src/diagnose/words.h"
#include "src/report/html.h"

#include <cmath>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using report::escaped;

std::string cell(double floors) {
    if (std::isnan(floors)) return "<td class=\"n\">\u2013</td>";
    return fmt::format("<td class=\"n heat size-{}\">{}</td>", size_class(floors),
                       escaped(floors_words(floors)));
}

}  // namespace

std::string recording_gaps_html(const gap::Evidence& evidence, const Predictions& predictions) {
    const std::vector<RunGaps> gaps = gaps_by_run(evidence, predictions);
    std::vector<gap::Signal> signals;
    for (std::size_t s = 0; s < gap::signal_count; ++s)
        if (std::isfinite(evidence.floor(static_cast<gap::Signal>(s))))
            signals.push_back(static_cast<gap::Signal>(s));
    std::string titles = "<th></th><th></th><th></th>",
                parts = "<th>Recording</th><th>Experiment</th><th class=\"n\">Length</th>";
    for (const gap::Signal signal : signals) {
        titles += fmt::format("<th colspan=\"{}\">{}</th>", predictions.is_explained ? 2 : 1,
                              capitalised(std::string(signal_words(signal))));
        parts += predictions.is_explained ? "<th class=\"n\">before</th><th class=\"n\">after</th>"
                                          : "<th class=\"n\">floors</th>";
    }
    std::string rows;
    for (std::size_t run = 0; run < gaps.size(); ++run) {
        const Recording& recording = evidence.recordings()[run];
        rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{:.1f} s</td>",
                            escaped(recording.name), escaped(recording.experiment),
                            static_cast<double>(recording.rows.size()) * recording.tick_s);
        for (const gap::Signal signal : signals) {
            const RunGap& size = gaps[run][gap::index_of(signal)];
            rows += cell(size.before);
            if (predictions.is_explained) rows += cell(size.after);
        }
        rows += "</tr>\n";
    }
    return fmt::format(
        "<div class=\"scroll\"><table class=\"data "
        "heat\"><thead><tr>{}</tr><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n<p "
        "class=\"remark\">R.m.s. error in noise floors on windows of 1 s{}; a dash: not recorded or not "
        "judged. An encoder at rest and a replayed controller can lie well below 1.</p>\n",
        titles, parts, rows,
        predictions.is_explained ? ", after: with the parameters fitted to all recordings" : "");
}

}  // namespace fidservo::diagnose
