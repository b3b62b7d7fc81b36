// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Times of day and dates as instruments write them into tables.
#include <cstdint>
#include <optional>
#include <string_view>

namespace fidservo {

/// A time of day, perhaps of a date.
struct ClockTime {
    std::int64_t ns = 0;  ///< since midnight, of 1970-01-01 where there is a date
    bool has_date = false;
    bool is_date_certain = true;  ///< false: day and month may be exchanged, as in 03/04/2020
    std::string_view date = {};   ///< the date as written
};

/// Reads H:MM:SS with a fraction after a point or comma, or MM:SS with a fraction; AM or PM behind it. In
/// front of it a date: Y-M-D, Y/M/D, D.M.Y, or with slashes D/M/Y and M/D/Y, of which the day above 12
/// decides. Between the two T or blanks; behind, Z or a zone as +01:00 where there is a date. Empty if it is
/// none.
std::optional<ClockTime> clock_time_of(std::string_view text);

}  // namespace fidservo
