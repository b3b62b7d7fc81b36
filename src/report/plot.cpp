// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/report/plot.h"

#include "core/demand.h"
#include "src/report/html.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace fidservo::report {
namespace {

/// JSON text inside a script element: "</" would end the element.
std::string quoted(const std::string& text) {
    std::string json = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') json += '\\';
        if (c == '<') {
            json += "\\u003c";
        } else if (static_cast<unsigned char>(c) >= 0x20) {
            json += c;
        }
    }
    return json + "\"";
}

std::string spans_json(const std::vector<Span>& spans) {
    std::string json;
    for (const Span& span : spans)
        json += fmt::format("{}[{:.3f},{:.3f},{},{}]", json.empty() ? "" : ",", span.from_s, span.to_s,
                            quoted(span.label), quoted(span.kind));
    return "[" + json + "]";
}

std::string traces_json(const std::vector<Trace>& traces) {
    std::string json;
    for (const Trace& trace : traces)
        json += fmt::format("{}{{\"label\":{},\"stepped\":{},\"digits\":{},\"faint\":{},\"data\":\"{}\"}}",
                            json.empty() ? "" : ",", quoted(trace.label), trace.stepped, trace.digits,
                            trace.faint, packed(trace.values));
    return "[" + json + "]";
}

}  // namespace

std::string time_plots(const TimeAxis& axis, const std::vector<TimePlot>& plots) {
    FIDSERVO_DEMAND(!plots.empty());
    const std::string& group = plots.front().group;
    std::string html = "<div class=\"plots\">\n";
    for (const TimePlot& plot : plots) {
        for (const Trace& trace : plot.traces) FIDSERVO_DEMAND(trace.values.size() == axis.time_s.size());
        html += fmt::format(
            "<figure class=\"plot\" data-plot=\"{}\"><figcaption>{} <span>{}</span></figcaption></figure>\n",
            plot.id, escaped(plot.title), escaped(plot.unit));
    }
    html +=
        "<p class=\"hint\">Drag across a plot to zoom in; double-click to see everything "
        "again.</p>\n</div>\n";
    html += fmt::format(
        "<script type=\"application/json\" data-axis=\"{}\">{{\"spans\":{},\"time\":\"{}\"}}</script>\n",
        group, spans_json(axis.spans), packed(axis.time_s));
    for (const TimePlot& plot : plots)
        html += fmt::format(
            "<script type=\"application/json\" "
            "data-traces=\"{}\">{{\"group\":{},\"unit\":{},\"height\":{},\"traces\":{}}}</script>\n",
            plot.id, quoted(plot.group), quoted(plot.unit), plot.height_px, traces_json(plot.traces));
    return html;
}

std::vector<std::size_t> envelope_rows(const std::vector<float>& guide, std::size_t limit) {
    std::vector<std::size_t> rows;
    const std::size_t count = guide.size();
    if (count <= limit) {
        rows.resize(count);
        for (std::size_t i = 0; i < count; ++i) rows[i] = i;
        return rows;
    }
    const std::size_t stretches = std::max<std::size_t>(1, limit / 2);
    for (std::size_t k = 0; k < stretches; ++k) {
        const std::size_t from = count * k / stretches, to = count * (k + 1) / stretches;
        const auto [low, high] = std::minmax_element(guide.begin() + static_cast<std::ptrdiff_t>(from),
                                                     guide.begin() + static_cast<std::ptrdiff_t>(to));
        const auto a = static_cast<std::size_t>(low - guide.begin());
        const auto b = static_cast<std::size_t>(high - guide.begin());
        rows.push_back(std::min(a, b));
        if (a != b) rows.push_back(std::max(a, b));
    }
    return rows;
}

}  // namespace fidservo::report
