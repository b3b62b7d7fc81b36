// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The windows of a recording that are judged.
//
// A stretch is a sequence of usable rows, one for each tick. It is cut into windows of 1 s; the last one may
// be shorter, down to 0.3 s. Where a model needs an initial state, this is estimated from the 100 ms before a
// window; the first 100 ms of the stretch serve for that only.
#include "core/recording.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Rows from `first` up to, not including, `end`.
struct Stretch {
    std::size_t first, end;
    std::size_t rows() const { return end - first; }
};

/// A window of the rows from `first` up to, not including, `end`; its initial state is estimated from the
/// rows from `lead` to `first`.
struct WindowRows {
    std::size_t lead, first, end;
};

/// The length of a window.
inline constexpr double window_s = 1.0;
/// What precedes a window, from which its initial state is estimated.
inline constexpr double lead_s = 0.1;

enum class LeadIn { none, estimates_state };

/// Stretches of usable rows that follow each other at the recording's tick.
/// @param usable  a flag for each row
std::vector<Stretch> stretches(const Recording& recording, const std::vector<bool>& usable);

/// The windows of a stretch; each begins where the one before ended. None if the stretch is too short.
std::vector<WindowRows> cut(const Stretch& stretch, double tick_s, LeadIn lead_in);

/// Number of rows in the 100 ms before a window.
std::size_t lead_rows(double tick_s);

}  // namespace fidservo::gap
