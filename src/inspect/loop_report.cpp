#include "src/inspect/loop_report.h"

#include "src/report/chart.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo::inspect {
namespace {

constexpr std::array shares{0.5, 0.9, 0.99, 0.999};

double us(TimeNs time_ns) {
    return 1e-3 * static_cast<double>(time_ns);
}

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
                    fmt::format("{:.0f} \u00b5s", us(loop.lateness.quantile_ns(share))));
    html += row("Latest", fmt::format("{:.0f} \u00b5s", us(loop.lateness.worst_ns)));
    html += row("Real-time priority (SCHED_FIFO)", loop.real_time_priority ? "yes" : "not permitted");
    html += row("Locked memory", loop.memory_locked ? "yes" : "not permitted") + "</table>";
    report::Histogram histogram{
        "late by, \u00b5s (the last bar holds everything beyond)", 0.0, bin_us, {"ticks"}, {{}}, {}};
    histogram.counts[0].resize(bins);
    for (std::size_t bin = 0; bin < loop.lateness.counts.size(); ++bin) {
        const double middle_us = us(control::LatenessHistogram::end_ns(bin)) - 0.5;
        const auto bar = std::min(static_cast<std::size_t>(middle_us / bin_us), bins - 1);
        histogram.counts[0][bar] += static_cast<int>(loop.lateness.counts[bin]);
    }
    return html + report::histogram_svg(histogram);
}

std::string loop_json(const control::LoopStatistics& loop) {
    nlohmann::ordered_json histogram = nlohmann::ordered_json::array();
    for (std::size_t bin = 0; bin < loop.lateness.counts.size(); ++bin)
        if (loop.lateness.counts[bin] > 0)
            histogram.push_back({us(control::LatenessHistogram::end_ns(bin)), loop.lateness.counts[bin]});
    const nlohmann::ordered_json json{{"ticks", loop.ticks},
                                      {"overruns", loop.overruns},
                                      {"held", loop.held},
                                      {"late_us",
                                       {{"median", us(loop.lateness.quantile_ns(0.5))},
                                        {"p99", us(loop.lateness.quantile_ns(0.99))},
                                        {"worst", us(loop.lateness.worst_ns)}}},
                                      {"late_histogram_us", histogram},
                                      {"real_time_priority", loop.real_time_priority},
                                      {"memory_locked", loop.memory_locked}};
    return json.dump();
}

}  // namespace fidservo::inspect
