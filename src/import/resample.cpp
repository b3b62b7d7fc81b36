// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/resample.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace fidservo::imports {

namespace {

/// The interval that a share of all do not exceed; 0 for fewer than two times.
TimeNs interval_of_share(std::span<const TimeNs> time_ns, double share) {
    if (time_ns.size() < 2) return 0;
    std::vector<TimeNs> intervals(time_ns.size() - 1);
    for (std::size_t k = 0; k < intervals.size(); ++k) intervals[k] = time_ns[k + 1] - time_ns[k];
    const auto at =
        intervals.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(intervals.size()));
    std::ranges::nth_element(intervals, at);
    return *at;
}

}  // namespace

TimeNs median_interval(std::span<const TimeNs> time_ns) {
    return interval_of_share(time_ns, 0.5);
}

bool is_steady(std::span<const TimeNs> time_ns, TimeNs tick_ns) {
    constexpr double same_rate = 0.01, least_share = 0.99;
    if (time_ns.size() < 2 || tick_ns <= 0) return false;
    std::size_t steady = 0;
    for (std::size_t k = 1; k < time_ns.size(); ++k) {
        const double ticks = static_cast<double>(time_ns[k] - time_ns[k - 1]) / static_cast<double>(tick_ns);
        steady += std::round(ticks) >= 1.0 && std::abs(ticks - std::round(ticks)) <= same_rate ? 1 : 0;
    }
    return static_cast<double>(steady) >= least_share * static_cast<double>(time_ns.size() - 1);
}

double nearby_tick_s(TimeNs interval_ns) {
    constexpr double near = 1e-3;
    const double measured_s = seconds(interval_ns);
    const double digit = std::pow(10.0, std::floor(std::log10(measured_s)) - 2.0);
    const double of_digits_s =
        std::strtod(fmt::format("{:.3g}", std::round(measured_s / digit) * digit).c_str(), nullptr);
    const double of_rate_s = 1.0 / std::max(1.0, std::round(1.0 / measured_s));
    const auto off = [&](double tick_s) { return std::abs(tick_s - measured_s); };
    const double nearest_s = off(of_rate_s) < off(of_digits_s) ? of_rate_s : of_digits_s;
    return off(nearest_s) < near * measured_s ? nearest_s : measured_s;
}

Resampler::Resampler(const std::vector<TimeNs>& time_ns, const std::vector<double>& values, Between between)
    : time_ns_(&time_ns),
      values_(&values),
      between_(between),
      longest_ns_(gap_in_intervals * static_cast<double>(interval_of_share(time_ns, usual_share))) {}

RowValue Resampler::at(TimeNs at_ns) {
    const std::vector<TimeNs>& times = *time_ns_;
    const std::vector<double>& values = *values_;
    while (before_ + 1 < times.size() && times[before_ + 1] <= at_ns) ++before_;
    const double value = values[before_];
    if (between_ == Between::hold || times[before_] == at_ns || before_ + 1 == times.size()) return {value};
    const double interval = static_cast<double>(times[before_ + 1] - times[before_]);
    const double share = static_cast<double>(at_ns - times[before_]) / interval;
    return {value + share * (values[before_ + 1] - value), interval > longest_ns_};
}

}  // namespace fidservo::imports
