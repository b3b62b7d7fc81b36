// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/report/device_figures.h"

#include "src/report/chart.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

constexpr std::array shares{0.5, 0.9, 0.99, 0.999};

std::string row(const std::string& what, const std::string& value) {
    return fmt::format("<tr><td>{}</td><td>{}</td></tr>", what, value);
}

}  // namespace

std::string loop_html(const control::LoopStatistics& loop) {
    constexpr double bin_us = 5.0;
    constexpr std::size_t bins = 40;
    std::string html = "<table>" + row("Ticks", std::to_string(loop.ticks)) +
                       row("Overruns: ticks that never began", std::to_string(loop.overruns)) +
                       row("Held ticks: no motion, the last command went on", std::to_string(loop.held));
    for (const double share : shares)
        html += row(fmt::format("{:g} % of the ticks late by at most", 100.0 * share),
                    fmt::format("{:.0f} \u00b5s", microseconds(loop.lateness.quantile_ns(share))));
    html += row("Latest", fmt::format("{:.0f} \u00b5s", microseconds(loop.lateness.worst_ns)));
    html += row("Real-time priority (SCHED_FIFO)", loop.real_time_priority ? "yes" : "not permitted");
    html += row("Locked memory", loop.memory_locked ? "yes" : "not permitted") + "</table>";
    report::Histogram histogram{
        "late by, \u00b5s (the last bar holds everything beyond)", 0.0, bin_us, {"ticks"}, {{}}, {}};
    histogram.counts[0].resize(bins);
    for (std::size_t bin = 0; bin < loop.lateness.counts.size(); ++bin) {
        const double middle_us = microseconds(control::LatenessHistogram::end_ns(bin)) - 0.5;
        const auto bar = std::min(static_cast<std::size_t>(middle_us / bin_us), bins - 1);
        histogram.counts[0][bar] += static_cast<int>(loop.lateness.counts[bin]);
    }
    return html + report::histogram_svg(histogram);
}

std::string frames_html(const vision::FrameCounts& frames) {
    return "<table>" + row("Used", std::to_string(frames.handed_out)) +
           row("Skipped: a newer one had come before anybody asked", std::to_string(frames.skipped)) +
           row("Lost: gaps in the camera's numbers", std::to_string(frames.lost)) +
           row("Damaged", std::to_string(frames.damaged)) +
           row("Without a time stamp", std::to_string(frames.unstamped)) +
           row("Reconnections", std::to_string(frames.reconnects)) + "</table>";
}

}  // namespace fidservo::inspect
