#include "src/report/chart.h"

#include "core/failure.h"
#include "src/report/html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::report {
namespace {

constexpr double left = 52, right = 708, top = 16, bottom = 236, height = 286, width = 720;

/// Linear map of an interval onto the drawing.
struct Scale {
    double from, to, at_from, at_to;
    double operator()(double v) const { return at_from + (v - from) / (to - from) * (at_to - at_from); }
};

/// 1, 2 or 5 times a power of ten, at least span / count.
double nice_step(double span, int count) {
    const double raw = span / count, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= raw * 0.999) return factor * power;
    return 10.0 * power;
}

std::string tick_text(double value, double step) {
    return number(value, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
}

std::string x_axis(const Scale& x, const std::string& label) {
    std::string svg;
    const double step = nice_step(x.to - x.from, 9);
    for (double v = std::ceil(x.from / step - 1e-9) * step; v <= x.to + 1e-9 * step; v += step)
        svg += fmt::format(
            "<line class=\"tick\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
            "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
            x(v), bottom, bottom + 5, bottom + 20, tick_text(v, step));
    svg += fmt::format("<line class=\"axis\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\"/>", left, right, bottom,
                       bottom);
    return svg + fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                             (left + right) / 2, height - 6, escaped(label));
}

std::string y_axis(const Scale& y, const std::string& label) {
    std::string svg;
    const double step = nice_step(y.to - y.from, 5);
    for (double v = y.from; v <= y.to + 1e-9 * step; v += step)
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
            "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
            left, right, y(v), y(v), left - 8, y(v) + 4, tick_text(v, step));
    return svg + fmt::format(
                     "<text class=\"label\" transform=\"translate(13 {}) rotate(-90)\" "
                     "text-anchor=\"middle\">{}</text>",
                     (top + bottom) / 2, escaped(label));
}

std::string opening(const std::string& description) {
    return fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", width,
                       height, escaped(description));
}

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
    const Scale x{h.low, h.low + h.width * static_cast<double>(bins), left, right};
    const Scale y{0.0, static_cast<double>(tallest), bottom, top};
    std::string svg = opening("Histogram over " + h.x_label);
    svg += y_axis(y, "Checks");
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
                           x(mark), top, bottom);
    svg += x_axis(x, h.x_label) + "</svg>\n<p class=\"legend\">";
    for (std::size_t kind = 0; kind < h.kinds.size(); ++kind)
        svg += fmt::format("<span class=\"part-{}\">{}</span>", kind, escaped(h.kinds[kind]));
    return svg + "</p>\n";
}

std::string share_chart_svg(const std::string& x_label, const std::string& y_label,
                            const std::vector<ShareCurve>& curves) {
    double widest = 0.0;
    for (const ShareCurve& curve : curves)
        for (const SharePoint& point : curve.points) widest = std::max(widest, point.x);
    FIDSERVO_DEMAND(widest > 0.0);
    const Scale x{0.0, widest * 1.05, left, right}, y{0.0, 1.0, bottom, top};
    std::string svg = opening(y_label + " over " + x_label) + y_axis(y, y_label);
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
    svg += x_axis(x, x_label) + "</svg>\n<p class=\"legend\">";
    for (std::size_t k = 0; k < curves.size(); ++k)
        svg += fmt::format("<span class=\"part-{}\">{}</span>", k, escaped(curves[k].name));
    return svg + "</p>\n";
}

}  // namespace fidservo::report
