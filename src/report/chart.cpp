// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/report/chart.h"

#include "core/demand.h"
#include "src/report/html.h"
#include "src/report/svg_axes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::report {
namespace {

constexpr ChartArea area;

}  // namespace

std::string histogram_svg(const Histogram& h) {
    FIDSERVO_DEMAND(!h.counts.empty() && h.counts.size() == h.kinds.size() && !h.counts.front().empty());
    const std::size_t bins = h.counts.front().size();
    int tallest = 1;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        int sum = 0;
        for (const auto& counts : h.counts) sum += counts[bin];
        tallest = std::max(tallest, sum);
    }
    const Scale x{h.low, h.low + h.width * static_cast<double>(bins), area.left, area.right};
    const Scale y{0.0, static_cast<double>(tallest), area.bottom, area.top};
    std::string svg = svg_opening(area, "Histogram over " + h.x_label);
    svg += svg_y_axis(area, y, "Checks");
    for (std::size_t bin = 0; bin < bins; ++bin) {
        int below = 0;
        for (std::size_t kind = 0; kind < h.counts.size(); ++kind) {
            const int count = h.counts[kind][bin];
            if (count == 0) continue;
            const double from = h.low + h.width * static_cast<double>(bin);
            svg += fmt::format(
                "<rect class=\"part-{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">"
                "<title>{}: {}</title></rect>",
                kind, x(from) + 0.5, y(below + count), x(from + h.width) - x(from) - 1,
                y(below) - y(below + count), escaped(h.kinds[kind]), count);
            below += count;
        }
    }
    for (const double mark : h.marks)
        svg += fmt::format("<line class=\"mark\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>",
                           x(mark), area.top, area.bottom);
    svg += svg_x_axis(area, x, h.x_label) + "</svg>\n";
    return svg + chart_legend(h.kinds);
}

std::string share_chart_svg(const std::string& x_label, const std::string& y_label,
                            const std::vector<ShareCurve>& curves) {
    double widest = 0.0;
    for (const ShareCurve& curve : curves)
        for (const SharePoint& point : curve.points) widest = std::max(widest, point.x);
    FIDSERVO_DEMAND(widest > 0.0);
    const Scale x{0.0, widest * 1.05, area.left, area.right}, y{0.0, 1.0, area.bottom, area.top};
    std::string svg = svg_opening(area, y_label + " over " + x_label) + svg_y_axis(area, y, y_label);
    for (std::size_t k = 0; k < curves.size(); ++k) {
        std::string path, bars;
        for (const SharePoint& p : curves[k].points) {
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(p.x), y(p.share));
            bars += fmt::format(
                "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>"
                "<circle cx=\"{0:.1f}\" cy=\"{3:.1f}\" r=\"3\"/>",
                x(p.x), y(p.low), y(p.high), y(p.share));
        }
        svg += fmt::format("<g class=\"curve part-{}\"><path d=\"{}\"/>{}</g>", k, path, bars);
    }
    svg += svg_x_axis(area, x, x_label) + "</svg>\n";
    std::vector<std::string> names(curves.size());
    std::ranges::transform(curves, names.begin(), &ShareCurve::name);
    return svg + chart_legend(names);
}

}  // namespace fidservo::report
