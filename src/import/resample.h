// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Signals with times of their own on the rows of a recording.
#include "core/time.h"

#include <span>
#include <vector>

namespace fidservo::imports {

enum class Between { line, hold };

/// The median interval of rising times, ns; 0 of fewer than two.
TimeNs median_interval(std::span<const TimeNs> time_ns);

/// An interval of more than one and a half of the usual ones lacks a sample.
inline constexpr double gap_in_intervals = 1.5;

/// What a signal is at a row's time.
struct RowValue {
    double value = 0.0;
    bool is_in_gap = false;  ///< of a line: the samples beside it are too far apart
};

/// Values at rising times, asked for in rising order. Between two samples a signal is on the line between
/// them, or what the earlier one says, as a converter holds its output. NaN beside a time makes a line NaN.
class Resampler {
  public:
    /// Keeps references. @param time_ns  rising, one at least
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
