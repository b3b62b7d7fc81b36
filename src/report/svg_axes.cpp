// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/report/svg_axes.h"

#include "src/report/html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::report {
namespace {

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

/// The multiples of a step that an axis spans.
std::vector<double> tick_values(const Scale& scale, double step) {
    constexpr double slack = 1e-9;
    const auto first = std::lround(std::ceil(scale.from / step - slack));
    const auto last = std::lround(std::floor(scale.to / step + slack));
    std::vector<double> values(static_cast<std::size_t>(std::max(0L, last - first + 1)));
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = step * static_cast<double>(first + static_cast<long>(i));
    return values;
}

}  // namespace

std::string svg_x_axis(const ChartArea& area, const Scale& x, const std::string& label) {
    std::string svg;
    const double step = nice_step(x.to - x.from, 9);
    for (const double v : tick_values(x, step))
        svg += fmt::format(
            "<line class=\"tick\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
            "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
            x(v), area.bottom, area.bottom + 5, area.bottom + 20, tick_text(v, step));
    svg += fmt::format("<line class=\"axis\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\"/>", area.left,
                       area.right, area.bottom, area.bottom);
    return svg + fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                             (area.left + area.right) / 2, area.height - 6, escaped(label));
}

std::string svg_y_axis(const ChartArea& area, const Scale& y, const std::string& label) {
    std::string svg;
    const double step = nice_step(y.to - y.from, 5);
    for (const double v : tick_values(y, step))
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
            "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
            area.left, area.right, y(v), y(v), area.left - 8, y(v) + 4, tick_text(v, step));
    return svg + fmt::format(
                     "<text class=\"label\" transform=\"translate(13 {}) rotate(-90)\" "
                     "text-anchor=\"middle\">{}</text>",
                     (area.top + area.bottom) / 2, escaped(label));
}

std::string svg_opening(const ChartArea& area, const std::string& description) {
    return fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
                       area.width, area.height, escaped(description));
}

std::string chart_legend(const std::vector<std::string>& names) {
    std::string html = "<p class=\"legend\">";
    for (std::size_t k = 0; k < names.size(); ++k)
        html += fmt::format("<span class=\"part-{}\">{}</span>", k, escaped(names[k]));
    return html + "</p>\n";
}

}  // namespace fidservo::report
