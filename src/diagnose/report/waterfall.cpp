// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/waterfall.h"

#include "core/rig.h"
#include "src/diagnose/words.h"
#include "src/report/html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using report::escaped;

constexpr double waterfall_width = 1100.0, left = 200.0, right = 700.0, row_height = 40.0, bar_height = 22.0,
                 top = 30.0;

/// Logarithmic, from a little below the floor to a little above the largest gap.
class LogAxis {
  public:
    LogAxis(double smallest, double largest)
        : low_(std::log10(std::clamp(0.9 * smallest, 0.1, 0.8))),
          high_(std::log10(std::max(2.0, 1.15 * largest))) {}

    double operator()(double floors) const {
        const double place = (std::log10(floors) - low_) / (high_ - low_);
        return left + std::max(0.0, place) * (right - left);
    }

    std::vector<double> ticks() const {
        constexpr double widest_with_all = 2.3;
        std::vector<double> values;
        for (int decade = static_cast<int>(std::floor(low_)); decade <= static_cast<int>(high_); ++decade)
            for (const double factor : {1.0, 2.0, 5.0}) {
                const double value = factor * std::pow(10.0, decade);
                if (factor > 1.0 && high_ - low_ > widest_with_all) continue;
                if (std::log10(value) >= low_ && std::log10(value) <= high_) values.push_back(value);
            }
        return values;
    }

  private:
    double low_, high_;
};

std::string text(double x, double y, std::string_view anchor, std::string_view kind, std::string_view words) {
    return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", kind, x,
                       y, anchor, escaped(words));
}

std::string tick_words(double tick) {
    constexpr double plain_below = 1e5;
    constexpr std::string_view factor = "1.00\u00d7";
    if (tick < plain_below) return fmt::format("{:g}", tick);
    const std::string text = three_digits(tick);
    return text.starts_with(factor) ? text.substr(factor.size()) : text;
}

/// A bar between two gaps, the smaller one first.
std::string bar(const LogAxis& x, double y, std::string_view kind, double from, double to) {
    constexpr double thinnest = 1.5;
    return fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{}\"/>", kind,
                       x(from), y + (row_height - bar_height) / 2, std::max(thinnest, x(to) - x(from)),
                       bar_height);
}

std::string removed_words(const gap::FoundEffect& effect) {
    return fmt::format("{} removed (95 %: {} to {})", share_words(effect.gap_removed),
                       share_words(effect.gap_removed_low), share_words(effect.gap_removed_high));
}

}  // namespace

std::vector<double> gap_after_steps(const gap::Diagnosis& diagnosis) {
    std::vector<double> steps;
    const double excess = diagnosis.gap.before * diagnosis.gap.before - 1.0;
    for (const gap::FoundEffect& effect : diagnosis.effects)
        steps.push_back(std::sqrt(std::max(0.0, 1.0 + (1.0 - effect.gap_removed) * excess)));
    if (!steps.empty()) steps.back() = diagnosis.gap.after;
    return steps;
}

std::string waterfall_svg(const gap::Diagnosis& diagnosis) {
    const std::vector<double> steps = gap_after_steps(diagnosis);
    const double before = diagnosis.gap.before;
    double smallest = before, largest = before;
    for (const double step : steps) {
        smallest = std::min(smallest, step);
        largest = std::max(largest, step);
    }
    const LogAxis x(smallest, largest);
    const double rows = static_cast<double>(steps.size()) + 2.0, bottom = top + rows * row_height;
    std::string svg = fmt::format(
        "<div class=\"scroll\"><svg class=\"waterfall\" viewBox=\"0 0 {} {:.0f}\" role=\"img\" "
        "aria-label=\"The gap in floors as effects enter\">",
        waterfall_width, bottom + 46);
    for (const double tick : x.ticks())
        svg += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2:.1f}\"/>",
                           x(tick), top, bottom) +
               text(x(tick), bottom + 18, "middle", "tick-label", tick_words(tick));
    svg += text((left + right) / 2, bottom + 38, "middle", "label", "gap in noise floors, logarithmic");

    double y = top;
    const auto row = [&](const std::string& name, const std::string& bars, const std::string& size,
                         const std::string& remark) {
        const double line = y + row_height / 2 + 4;
        svg += text(left - 12, line, "end", "name", name) + bars +
               text(right + 14, line, "start", "value", size) +
               text(right + 84, line, "start", "remark", remark);
        y += row_height;
    };
    const auto from_floor = [&](std::string_view kind, double gap) {
        return bar(x, y, fmt::format("{} size-{}", kind, size_class(gap)), std::min(1.0, gap),
                   std::max(1.0, gap));
    };
    row("Rig file as it is", from_floor("whole", before), three_digits(before), "floors");
    double last = before;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const gap::FoundEffect& effect = diagnosis.effects[k];
        row("+ " + readable(effect.effect),
            bar(x, y, "removed", std::min(last, steps[k]), std::max(last, steps[k])), three_digits(steps[k]),
            removed_words(effect));
        last = steps[k];
    }
    row("What is left", from_floor("whole", diagnosis.gap.after), three_digits(diagnosis.gap.after),
        "floors");
    svg += fmt::format("<line class=\"floor\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2:.1f}\"/>",
                       x(1.0), top - 8, bottom) +
           text(x(1.0), top - 13, "middle", "floor-label", "noise floor");
    return svg + "</svg></div>\n";
}

}  // namespace fidservo::diagnose
