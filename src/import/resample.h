// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Resamples signals with times of their own to the rows of a recording.
#include "core/time.h"

#include <span>
#include <vector>

namespace fidservo::imports {

enum class Between { line, hold };

/// The median interval of increasing times, ns; 0 for fewer than two.
TimeNs median_interval(std::span<const TimeNs> time_ns);

/// Whether 99 % of the intervals are a whole number of ticks, within 1 % of a tick.
bool is_steady(std::span<const TimeNs> time_ns, TimeNs tick_ns);

/// The nearest usual tick, s: one of a whole number of hertz, or of a number of seconds with three digits. If
/// none is within 0.1 % of the interval, the interval itself.
double nearby_tick_s(TimeNs interval_ns);

/// An interval is a gap if it is longer than gap_in_intervals times the usual interval, which is the
/// usual_share quantile of all intervals.
inline constexpr double gap_in_intervals = 1.5, usual_share = 0.95;

/// A signal's value at a row's time.
struct RowValue {
    double value = 0.0;
    bool is_in_gap = false;  ///< whether the row lies in a gap between two samples; only with interpolation
};

/// Evaluates a signal at increasing times. Between two samples it is interpolated linearly, or held at the
/// earlier one, as a converter holds its output. An interpolated value is NaN if a neighbouring sample is.
class Resampler {
  public:
    /// Refers to its arguments, which must outlive it.
    /// @param time_ns  increasing; at least one
    Resampler(const std::vector<TimeNs>& time_ns, const std::vector<double>& values, Between between);
    /// @param at_ns  from the first time to the last
    RowValue at(TimeNs at_ns);

  private:
    const std::vector<TimeNs>* time_ns_;
    const std::vector<double>* values_;
    Between between_;
    double longest_ns_;
    std::size_t before_ = 0;
};

}  // namespace fidservo::imports
