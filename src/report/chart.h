// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Charts as plain SVG: no script, sharp on paper. Colours come from the page's style sheet.
#include <optional>
#include <string>
#include <vector>

namespace fidservo::report {

/// Bars side by side; the bars of one stack lie on one another in the order of `kinds`.
struct Histogram {
    std::string x_label;
    double low, width;                     ///< left edge and width of the first bin
    std::vector<std::string> kinds;        ///< names of the stacked parts
    std::vector<std::vector<int>> counts;  ///< counts[kind][bin]
    std::vector<double> marks;             ///< dashed vertical lines, e.g. the limits
};

std::string histogram_svg(const Histogram& histogram);

/// A fraction (0..1) over a size, with its confidence interval.
struct SharePoint {
    double x, share, low, high;
};

struct ShareCurve {
    std::string name;
    std::vector<SharePoint> points;
};

std::string share_chart_svg(const std::string& x_label, const std::string& y_label,
                            const std::vector<ShareCurve>& curves);

}  // namespace fidservo::report
