// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/utc_time.h"

#include <charconv>
#include <chrono>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace fidservo {
namespace {

constexpr std::string_view shape = "0000-00-00T00:00:00Z";

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

/// Of text that has the shape.
unsigned number_at(std::string_view text, std::size_t begin, std::size_t digits) {
    unsigned number = 0;
    std::from_chars(text.data() + begin, text.data() + begin + digits, number);
    return number;
}

}  // namespace

bool is_utc_time(std::string_view text) {
    if (text.size() != shape.size()) return false;
    for (std::size_t k = 0; k < shape.size(); ++k)
        if (shape[k] == '0' ? !is_digit(text[k]) : text[k] != shape[k]) return false;
    const std::chrono::year_month_day date(std::chrono::year(static_cast<int>(number_at(text, 0, 4))),
                                           std::chrono::month(number_at(text, 5, 2)),
                                           std::chrono::day(number_at(text, 8, 2)));
    return date.ok() && number_at(text, 11, 2) < 24 && number_at(text, 14, 2) < 60 &&
           number_at(text, 17, 2) < 60;
}

std::string utc_now() {
    const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

}  // namespace fidservo
