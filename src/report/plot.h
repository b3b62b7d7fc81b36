// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Plots over time that can be zoomed and panned (by uPlot, src/web/report.js).
#include <string>
#include <vector>

namespace fidservo::report {

struct Trace {
    std::string label;
    std::vector<float> values;  ///< NaN: no value
    bool stepped = false;       ///< held between samples, as a setpoint is
    int digits = 3;             ///< decimals in the legend
    bool faint = false;         ///< drawn lightly behind the others
};

/// A marked stretch of the time axis.
struct Span {
    double from_s, to_s;
    std::string label;
    std::string kind;  ///< good | bad | unsure | neutral
};

/// Traces on one pair of axes, with one value for each time.
struct TimePlot {
    std::string id;  ///< unique in the page
    std::string title;
    std::string unit;   ///< of the vertical axis
    std::string group;  ///< plots of one group share the cursor and the zoom
    int height_px = 220;
    std::vector<Trace> traces;
};

/// Times and marked stretches, shared by the plots of a group.
struct TimeAxis {
    std::vector<double> time_s;
    std::vector<Span> spans;
};

/// The plots of one group, one above the other. Values travel as base64 of little-endian float32.
std::string time_plots(const TimeAxis& axis, const std::vector<TimePlot>& plots);

/// Reduces the number of points without changing the picture: within each of `limit / 2` stretches of equal
/// length, keeps the rows where `guide` is smallest and largest. Returns indices in ascending order; all of
/// them if there are few.
std::vector<std::size_t> envelope_rows(const std::vector<float>& guide, std::size_t limit);

}  // namespace fidservo::report
