// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/report/xy_chart.h"

#include "core/demand.h"
#include "src/report/svg_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fidservo::report {
namespace {

constexpr ChartArea xy_area{.left = 60.0, .bottom = 316.0, .height = 366.0};

/// The interval of all values, a little wider.
struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void include(double value) {
        if (!std::isfinite(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    Scale onto(double at_low, double at_high) const {
        constexpr double margin = 0.03;
        const double width = std::max(high - low, 1e-9 * std::max(std::abs(high), 1.0));
        return {low - margin * width, high + margin * width, at_low, at_high};
    }
};

std::string dots_of(const XyCurve& curve, const Scale& x, const Scale& y) {
    std::string svg;
    for (std::size_t i = 0; i < curve.x.size(); ++i)
        if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]))
            svg +=
                fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\"/>", x(curve.x[i]), y(curve.y[i]));
    return svg;
}

/// Points that lie on the last drawn one are left out.
std::string line_of(const XyCurve& curve, const Scale& x, const Scale& y) {
    constexpr double least_step = 0.4;
    std::string path;
    bool pen_down = false;
    double last_x = 0.0, last_y = 0.0;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) {
            pen_down = false;
            continue;
        }
        const double at_x = x(curve.x[i]), at_y = y(curve.y[i]);
        if (pen_down && std::hypot(at_x - last_x, at_y - last_y) < least_step) continue;
        path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", at_x, at_y);
        pen_down = true;
        last_x = at_x;
        last_y = at_y;
    }
    return fmt::format("<path d=\"{}\"/>", path);
}

}  // namespace

std::string xy_chart_svg(const std::string& x_label, const std::string& y_label,
                         const std::vector<XyCurve>& curves) {
    Range x_range, y_range;
    for (const XyCurve& curve : curves) {
        FIDSERVO_DEMAND(curve.x.size() == curve.y.size());
        for (const double value : curve.x) x_range.include(value);
        for (const double value : curve.y) y_range.include(value);
    }
    FIDSERVO_DEMAND(x_range.low <= x_range.high && y_range.low <= y_range.high);
    const Scale x = x_range.onto(xy_area.left, xy_area.right), y = y_range.onto(xy_area.bottom, xy_area.top);
    std::string svg = svg_opening(xy_area, y_label + " over " + x_label) + svg_y_axis(xy_area, y, y_label);
    std::vector<std::string> names(curves.size());
    for (std::size_t k = 0; k < curves.size(); ++k) {
        names[k] = curves[k].name;
        svg += fmt::format("<g class=\"curve part-{}\">{}</g>", k,
                           curves[k].dots ? dots_of(curves[k], x, y) : line_of(curves[k], x, y));
    }
    return svg + svg_x_axis(xy_area, x, x_label) + "</svg>\n" + chart_legend(names);
}

}  // namespace fidservo::report
