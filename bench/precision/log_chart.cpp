// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/precision/log_chart.h"

#include "src/report/html.h"
#include "src/report/svg_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fidservo::bench {
namespace {

using report::escaped;

constexpr report::ChartArea area{
    .left = 64.0, .right = 800.0, .bottom = 396.0, .width = 820.0, .height = 446.0};

/// Whole decades and their thirds around all values.
struct LogScale {
    double low, high;  ///< exponents of ten
    double at_low, at_high;
    double operator()(double value) const {
        return at_low + (std::log10(value) - low) / (high - low) * (at_high - at_low);
    }
};

std::string tick_text(double value) {
    return value >= 1.0 ? fmt::format("{:.0f}", value) : fmt::format("{:g}", value);
}

std::vector<double> ticks_of(const LogScale& scale) {
    std::vector<double> ticks;
    for (double decade = std::floor(scale.low); decade <= std::ceil(scale.high); decade += 1.0)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double exponent = decade + std::log10(digit);
            if (exponent >= scale.low - 1e-9 && exponent <= scale.high + 1e-9)
                ticks.push_back(digit * std::pow(10.0, decade));
        }
    return ticks;
}

std::string axes(const LogScale& x, const LogScale& y, const std::string& x_label,
                 const std::string& y_label) {
    std::string svg;
    for (const double value : ticks_of(y))
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
            "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
            area.left, area.right, y(value), y(value), area.left - 8, y(value) + 4, tick_text(value));
    for (const double value : ticks_of(x))
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
            "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
            x(value), area.top, area.bottom, area.bottom + 18, tick_text(value));
    return svg + fmt::format(
                     "<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>"
                     "<text class=\"label\" transform=\"translate(13 {}) rotate(-90)\" "
                     "text-anchor=\"middle\">{}</text>",
                     (area.left + area.right) / 2, area.height - 6, escaped(x_label),
                     (area.top + area.bottom) / 2, escaped(y_label));
}

/// Puts names beside their dots, where they do not cover names that are there already.
class Names {
  public:
    std::string beside(double x, double y, const std::string& name) {
        const double width = 7.4 * static_cast<double>(name.size());
        const bool left = x > 0.72 * area.right;
        const double from = left ? x - 11 - width : x + 11;
        double base = y + 4.5;
        for (const double shift : {0.0, -15.0, 15.0, -30.0, 30.0})
            if (is_free({from, y + 4.5 + shift, width})) {
                base = y + 4.5 + shift;
                break;
            }
        taken_.push_back({from, base, width});
        return fmt::format(
            "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" style=\"fill:var(--part);font-weight:650;"
            "paint-order:stroke;stroke:var(--card);stroke-width:4px\">{}</text>",
            left ? x - 11 : x + 11, base, left ? "end" : "start", escaped(name));
    }

  private:
    struct Box {
        double from, base, width;
    };
    bool is_free(const Box& box) const {
        return std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
            return std::abs(box.base - other.base) < 14.0 && box.from < other.from + other.width &&
                   other.from < box.from + box.width;
        });
    }
    std::vector<Box> taken_;
};

std::string dots(const LogSeries& series, const LogScale& x, const LogScale& y, Names& names) {
    std::string small, large;
    for (const LogPoint& point : series.points) {
        const double at_x = x(point.x), at_y = y(point.y);
        std::string& to = point.main ? large : small;
        to += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" opacity=\"{}\"><title>{}</title></circle>", at_x,
            at_y, point.main ? 6.5 : 3.0, point.main ? 1.0 : 0.45, escaped(point.hint));
        if (point.main) to += names.beside(at_x, at_y, series.name);
    }
    return fmt::format("<g class=\"curve\" style=\"--part:{}\">{}{}</g>", series.colour, small, large);
}

}  // namespace

std::string log_chart_svg(const std::string& x_label, const std::string& y_label,
                          const std::vector<LogSeries>& series, const LogLine& floor) {
    double x_low = std::numeric_limits<double>::infinity(), x_high = 0.0, y_low = floor.y, y_high = floor.y;
    for (const LogSeries& one : series)
        for (const LogPoint& point : one.points) {
            x_low = std::min(x_low, point.x);
            x_high = std::max(x_high, point.x);
            y_low = std::min(y_low, point.y);
            y_high = std::max(y_high, point.y);
        }
    constexpr double margin = 0.12;
    const LogScale x{std::log10(x_low) - margin, std::log10(x_high) + margin, area.left, area.right};
    const LogScale y{std::log10(y_low) - margin, std::log10(y_high) + margin, area.bottom, area.top};
    std::string svg = report::svg_opening(area, y_label + " over " + x_label) + axes(x, y, x_label, y_label);
    svg += fmt::format(
        "<line class=\"mark\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
        "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\" style=\"fill:var(--bad)\">{}</text>",
        area.left, area.right, y(floor.y), y(floor.y), area.right - 4, y(floor.y) + 15, escaped(floor.name));
    Names names;
    for (const LogSeries& one : series) svg += dots(one, x, y, names);
    return svg + "</svg>\n";
}

}  // namespace fidservo::bench
