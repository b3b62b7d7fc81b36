// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The report's figures.
#include "core/recording.h"
#include "src/report/plot.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo::reproduce {

/// A trace over all rows of a recording, before thinning.
struct Signal {
    std::string label;
    std::vector<double> values;
    bool stepped = false;
    int digits = 3;
    bool faint = false;
};

/// Signals on one pair of axes.
struct SignalPlot {
    std::string title;
    std::string unit;
    std::vector<Signal> signals;
    int height_px = 220;
};

/// A figure of plots over time that zoom together, with what there is to see in it.
/// @param id  unique in the report; the first plot's last signal decides which rows survive thinning
std::string time_figure(const std::string& id, const std::string& caption, double tick_s,
                        const std::vector<SignalPlot>& plots);

/// A figure around a chart.
std::string chart_figure(const std::string& caption, const std::string& svg);

/// A table: a row of titles, then rows of cells; numbers are aligned to the right.
std::string table_html(const std::vector<std::string>& titles,
                       const std::vector<std::vector<std::string>>& rows);

/// One column of a recording's rows.
std::vector<double> column(const Recording& recording, double StageRow::*member);

}  // namespace fidservo::reproduce
