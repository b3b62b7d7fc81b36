// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/clock_time.h"

#include "src/files/table/text_file.h"

#include <charconv>
#include <chrono>
#include <cstdint>

namespace fidservo {

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/// Takes pieces off the front of a text.
class Scanner {
  public:
    explicit Scanner(std::string_view text) : rest_(text) {}

    std::optional<int> digits(std::size_t least, std::size_t most) {
        const std::size_t size = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
        if (size < least || size > most) return std::nullopt;
        int value = 0;
        std::from_chars(rest_.data(), rest_.data() + size, value);
        rest_.remove_prefix(size);
        return value;
    }
    /// ns of the digits behind a point or comma; those beyond the ninth are left out.
    std::optional<std::int64_t> fraction_ns() {
        if (!one_of(".,")) return std::nullopt;
        const std::size_t size = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
        if (size == 0) return std::nullopt;
        std::int64_t ns = 0;
        for (std::size_t k = 0; k < 9; ++k) ns = 10 * ns + (k < size ? rest_[k] - '0' : 0);
        rest_.remove_prefix(size);
        return ns;
    }
    std::optional<char> one_of(std::string_view letters) {
        if (rest_.empty() || letters.find(rest_.front()) == std::string_view::npos) return std::nullopt;
        const char letter = rest_.front();
        rest_.remove_prefix(1);
        return letter;
    }
    bool word(std::string_view word) {
        if (!rest_.starts_with(word)) return false;
        rest_.remove_prefix(word.size());
        return true;
    }
    void blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size())); }
    std::string_view rest() const { return rest_; }

  private:
    std::string_view rest_;
};

std::optional<std::int64_t> days_of(int year, int month, int day) {
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok()) return std::nullopt;
    return std::chrono::sys_days(date).time_since_epoch().count();
}

struct Date {
    std::int64_t days;
    bool is_certain;
};

std::optional<Date> date_of(Scanner& scan) {
    const auto first = scan.digits(1, 4);
    const auto separator = scan.one_of("-/.");
    if (!first || !separator) return std::nullopt;
    const std::string_view again(&*separator, 1);
    const auto second = scan.digits(1, 2);
    if (!second || !scan.one_of(again)) return std::nullopt;
    const auto third = scan.digits(1, 4);
    if (!third) return std::nullopt;
    const auto certain = [](std::optional<std::int64_t> days) {
        return days ? std::optional(Date{*days, true}) : std::nullopt;
    };
    if (*first > 999) return certain(days_of(*first, *second, *third));
    if (*third < 1000) return std::nullopt;
    const auto day_first = days_of(*third, *second, *first), month_first = days_of(*third, *first, *second);
    if (*separator == '.') return certain(day_first);
    if (!day_first || !month_first || *first == *second) return certain(day_first ? day_first : month_first);
    return Date{*day_first, false};
}

std::optional<std::int64_t> time_of_day(Scanner& scan) {
    const auto first = scan.digits(1, 2);
    if (!first || !scan.one_of(":")) return std::nullopt;
    const auto second = scan.digits(2, 2);
    if (!second) return std::nullopt;
    const bool has_hours = scan.one_of(":").has_value();
    const auto third = has_hours ? scan.digits(2, 2) : std::optional(0);
    if (!third) return std::nullopt;
    const bool has_fraction = scan.rest().starts_with('.') || scan.rest().starts_with(',');
    if (!has_hours && !has_fraction) return std::nullopt;
    const auto fraction = has_fraction ? scan.fraction_ns() : std::optional<std::int64_t>(0);
    if (!fraction) return std::nullopt;
    const int hours = has_hours ? *first : 0, minutes = has_hours ? *second : *first,
              seconds = has_hours ? *third : *second;
    constexpr int leap_second = 60;
    if (hours > 23 || minutes > 59 || seconds > leap_second) return std::nullopt;
    return (hours * 3600LL + minutes * 60 + seconds) * second_ns + *fraction;
}

/// Moves a time of a clock of twelve hours; false if it shows none.
bool apply_half_of_day(Scanner& scan, std::int64_t& ns) {
    constexpr std::int64_t half_day_ns = 12 * 3600 * second_ns;
    scan.blanks();
    const bool morning = scan.word("AM") || scan.word("am"),
               evening = !morning && (scan.word("PM") || scan.word("pm"));
    if (!morning && !evening) return true;
    if (ns >= half_day_ns + 3600 * second_ns || ns < 3600 * second_ns) return false;
    ns = ns % half_day_ns + (evening ? half_day_ns : 0);
    return true;
}

bool apply_zone(Scanner& scan, std::int64_t& ns) {
    if (scan.one_of("Zz")) return true;
    const auto sign = scan.one_of("+-");
    if (!sign) return true;
    const auto hours = scan.digits(2, 2);
    (void)scan.one_of(":");
    const auto minutes = scan.digits(2, 2);
    if (!hours || !minutes) return false;
    ns -= (*sign == '+' ? 1 : -1) * (*hours * 3600LL + *minutes * 60) * second_ns;
    return true;
}

}  // namespace

std::optional<ClockTime> clock_time_of(std::string_view text) {
    constexpr std::int64_t day_ns = 24 * 3600 * second_ns;
    text = without_blanks(text);
    if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
    ClockTime time;
    Scanner scan(text);
    if (const std::size_t separator = text.find_first_of("-/.:");
        separator != std::string_view::npos && text[separator] != ':') {
        const auto date = date_of(scan);
        // Years of which a time in ns has room.
        constexpr std::int64_t most_days = 100'000;
        if (!date || date->days > most_days || date->days < -most_days) return std::nullopt;
        time.has_date = true;
        time.is_date_certain = date->is_certain;
        time.date = text.substr(0, text.size() - scan.rest().size());
        time.ns = date->days * day_ns;
        if (!scan.one_of("T")) {
            if (!scan.rest().starts_with(' ')) return std::nullopt;
            scan.blanks();
        }
    }
    auto of_day = time_of_day(scan);
    if (!of_day || !apply_half_of_day(scan, *of_day)) return std::nullopt;
    if (time.has_date && !apply_zone(scan, *of_day)) return std::nullopt;
    if (!scan.rest().empty()) return std::nullopt;
    time.ns += *of_day;
    return time;
}

}  // namespace fidservo
