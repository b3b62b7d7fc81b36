// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/reproduce/figures.h"

#include "core/demand.h"
#include "src/report/html.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

constexpr std::size_t most_points = 3000;

bool is_numeric(const std::string& cell) {
    return !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell.front())) != 0 ||
                             cell.starts_with('-') || cell.starts_with("\u2212"));
}

}  // namespace

std::string time_figure(const std::string& id, const std::string& caption, double tick_s,
                        const std::vector<SignalPlot>& plots) {
    FIDSERVO_DEMAND(!plots.empty() && !plots.front().signals.empty());
    const std::vector<double>& leading = plots.front().signals.back().values;
    const std::vector<float> guide(leading.begin(), leading.end());
    const std::vector<std::size_t> rows = report::envelope_rows(guide, most_points);
    report::TimeAxis axis;
    axis.time_s.resize(rows.size());
    std::ranges::transform(rows, axis.time_s.begin(),
                           [&](std::size_t row) { return tick_s * static_cast<double>(row); });
    std::vector<report::TimePlot> drawn;
    drawn.reserve(plots.size());
    for (const SignalPlot& plot : plots) {
        report::TimePlot& to = drawn.emplace_back();
        to = {fmt::format("{}-{}", id, drawn.size()), plot.title, plot.unit, id, plot.height_px, {}};
        to.traces.reserve(plot.signals.size());
        for (const Signal& signal : plot.signals) {
            report::Trace& trace = to.traces.emplace_back(
                report::Trace{signal.label, {}, signal.stepped, signal.digits, signal.faint});
            trace.values.resize(rows.size());
            std::ranges::transform(rows, trace.values.begin(), [&](std::size_t row) {
                return static_cast<float>(signal.values.at(row));
            });
        }
    }
    return report::time_plots(axis, drawn) +
           fmt::format("<p class=\"caption\">{}</p>\n", report::escaped(caption));
}

std::string chart_figure(const std::string& caption, const std::string& svg) {
    return fmt::format("{}<p class=\"caption\">{}</p>\n", svg, report::escaped(caption));
}

std::string table_html(const std::vector<std::string>& titles,
                       const std::vector<std::vector<std::string>>& rows) {
    std::string html = "<div class=\"scroll\"><table class=\"data\"><thead><tr>";
    for (std::size_t i = 0; i < titles.size(); ++i) {
        const bool numeric = !rows.empty() && is_numeric(rows.front().at(i));
        html += fmt::format("<th{}>{}</th>", numeric ? " class=\"n\"" : "", report::escaped(titles[i]));
    }
    html += "</tr></thead><tbody>\n";
    for (const auto& row : rows) {
        html += "<tr>";
        for (const std::string& cell : row)
            html +=
                fmt::format("<td{}>{}</td>", is_numeric(cell) ? " class=\"n\"" : "", report::escaped(cell));
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::vector<double> column(const Recording& recording, double StageRow::*member) {
    std::vector<double> values(recording.rows.size());
    std::ranges::transform(recording.rows, values.begin(), member);
    return values;
}

}  // namespace fidservo::reproduce
