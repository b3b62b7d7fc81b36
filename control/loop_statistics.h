// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How punctual the control loop was.
#include "core/time.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace fidservo::control {

/// How late each tick began: bins of 1 us up to 1 ms, then of a factor of two each.
struct LatenessHistogram {
    static constexpr std::size_t fine_bins = 1000;
    static constexpr std::size_t coarse_bins = 16;  ///< the last one has all beyond 32 s

    std::array<std::uint64_t, fine_bins + coarse_bins> counts{};
    TimeNs worst_ns = 0;

    static std::size_t bin_of(TimeNs late_ns) noexcept;
    /// Where a bin ends, ns.
    static TimeNs end_ns(std::size_t bin) noexcept;

    std::uint64_t total() const;
    /// The lateness that a share of the ticks does not exceed, ns: the end of its bin, at most the worst.
    /// 0 without ticks.
    TimeNs quantile_ns(double share) const;
};

struct LoopStatistics {
    std::uint64_t ticks = 0;
    std::uint64_t overruns = 0;  ///< ticks that were due and never began, since the one before was late
    std::uint64_t held = 0;      ///< ticks that nobody controlled: the last command went on
    LatenessHistogram lateness;
    bool real_time_priority = false;
    bool memory_locked = false;
};

}  // namespace fidservo::control
