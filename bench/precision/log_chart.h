// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Points on two logarithmic axes as plain SVG, for src/report's style sheet.
#include <string>
#include <vector>

namespace fidservo::bench {

struct LogPoint {
    double x, y;        ///< more than 0
    std::string hint;   ///< shown where a pointer rests on it
    bool main = false;  ///< drawn large, with the series' name beside it
};

struct LogSeries {
    std::string name;
    std::string colour;
    std::vector<LogPoint> points;
};

struct LogLine {
    std::string name;
    double y;
};

std::string log_chart_svg(const std::string& x_label, const std::string& y_label,
                          const std::vector<LogSeries>& series, const LogLine& floor);

}  // namespace fidservo::bench
