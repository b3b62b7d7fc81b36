// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Axes of a chart in plain SVG. Colours come from the page's style sheet.
#include <string>
#include <vector>

namespace fidservo::report {

/// The drawing inside the axes, and all of the chart.
struct ChartArea {
    double left = 52.0, right = 708.0, top = 16.0, bottom = 236.0;
    double width = 720.0, height = 286.0;
};

/// Linear map of an interval onto the drawing.
struct Scale {
    double from, to, at_from, at_to;
    double operator()(double v) const { return at_from + (v - from) / (to - from) * (at_to - at_from); }
};

/// The opening tag of a chart, with a description for people who cannot see it.
std::string svg_opening(const ChartArea& area, const std::string& description);

/// Ticks and label below the drawing.
std::string svg_x_axis(const ChartArea& area, const Scale& x, const std::string& label);

/// Grid lines and label at the left of the drawing.
std::string svg_y_axis(const ChartArea& area, const Scale& y, const std::string& label);

/// The names of a chart's parts, each with its colour, below the chart.
std::string chart_legend(const std::vector<std::string>& names);

}  // namespace fidservo::report
