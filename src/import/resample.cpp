// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/resample.h"

#include <algorithm>

namespace fidservo::imports {

TimeNs median_interval(std::span<const TimeNs> time_ns) {
    if (time_ns.size() < 2) return 0;
    std::vector<TimeNs> intervals(time_ns.size() - 1);
    for (std::size_t k = 0; k < intervals.size(); ++k) intervals[k] = time_ns[k + 1] - time_ns[k];
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::ranges::nth_element(intervals, middle);
    return *middle;
}

Resampler::Resampler(const std::vector<TimeNs>& time_ns, const std::vector<double>& values, Between between)
    : time_ns_(&time_ns),
      values_(&values),
      between_(between),
      longest_ns_(gap_in_intervals * static_cast<double>(median_interval(time_ns))) {}

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
