// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One quantity over another as plain SVG: loops, characteristics, anything that is not a trace over time.
#include <string>
#include <vector>

namespace fidservo::report {

struct XyCurve {
    std::string name;
    std::vector<double> x, y;  ///< of equal length; not finite: a gap
    bool dots = false;         ///< separate points in place of a line
};

/// @param x_label, y_label  with units
std::string xy_chart_svg(const std::string& x_label, const std::string& y_label,
                         const std::vector<XyCurve>& curves);

}  // namespace fidservo::report
