// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which rows of a recording are judged, in windows.
//
// A stretch is a run of usable rows, one a tick. It is cut into windows of 1 s, the last one shorter where at
// least 0.3 s are left. Where a model needs a state to begin with, the stretch's first 100 ms are only there
// to find it, as the last 100 ms of each window are for the next one.
#include "core/recording.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Rows from `first` up to, not including, `end`.
struct Stretch {
    std::size_t first, end;
    std::size_t rows() const { return end - first; }
};

/// A window's rows, and where the rows before it begin from which its first state is estimated.
struct WindowRows {
    std::size_t lead, first, end;
};

enum class LeadIn { none, estimates_state };

/// Stretches of usable rows that follow each other at the recording's tick.
/// @param usable  one value a row
std::vector<Stretch> stretches(const Recording& recording, const std::vector<bool>& usable);

/// The windows of a stretch; each begins where the one before ended. Empty if it is too short.
std::vector<WindowRows> cut(const Stretch& stretch, double tick_s, LeadIn lead_in);

/// Rows that make up the 100 ms before a window.
std::size_t lead_rows(double tick_s);

}  // namespace fidservo::gap
