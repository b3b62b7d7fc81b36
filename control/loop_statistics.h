// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How punctual the control loop was: statistics of its ticks.
#include "core/time.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace fidservo::control {

/// A histogram of how late the ticks began: bins of 1 us up to 1 ms, then bins whose ends grow by a factor of
/// two.
struct LatenessHistogram {
    static constexpr std::size_t fine_bins = 1000;
    static constexpr std::size_t coarse_bins = 16;  ///< the last one holds everything beyond 32 s

    std::array<std::uint64_t, fine_bins + coarse_bins> counts{};
    TimeNs worst_ns = 0;

    static std::size_t bin_of(TimeNs late_ns) noexcept;
    /// The upper end of a bin, ns.
    static TimeNs end_ns(std::size_t bin) noexcept;

    std::uint64_t total() const;
    /// The lateness that a given fraction of the ticks does not exceed, ns: the upper end of its bin, or the
    /// worst lateness if that is less. 0 without ticks.
    TimeNs quantile_ns(double share) const;
};

struct LoopStatistics {
    std::uint64_t ticks = 0;
    std::uint64_t overruns = 0;  ///< ticks that were left out because the one before ran past their deadline
    std::uint64_t held = 0;      ///< ticks at which no program ran, so that the last command was held
    LatenessHistogram lateness;
    bool real_time_priority = false;
    bool memory_locked = false;
};

}  // namespace fidservo::control
