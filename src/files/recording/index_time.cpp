// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/index_time.h"

#include "src/files/table/text_file.h"

#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace fidservo {

namespace {

struct IndexUnit {
    std::string_view name;
    std::size_t decimals;  ///< digits behind the point that are whole ns
};

constexpr std::array index_units{IndexUnit{"ns", 0}, IndexUnit{"us", 3}, IndexUnit{"ms", 6},
                                 IndexUnit{"s", 9}};

std::optional<TimeNs> in_ns(std::string_view whole, std::string_view fraction, std::size_t decimals) {
    std::string digits(whole);
    for (std::size_t k = 0; k < decimals; ++k) digits += k < fraction.size() ? fraction[k] : '0';
    TimeNs time_ns = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), time_ns);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    const bool rounds_up = fraction.size() > decimals && fraction[decimals] >= '5';
    return time_ns + (rounds_up ? 1 : 0);
}

bool are_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

std::string index_unit_of(std::string_view title) {
    constexpr std::array<std::string_view, 2> micro_seconds{"\xC2\xB5s", "\xCE\xBCs"};
    title = without_blanks(title);
    for (const std::string_view micro : micro_seconds)
        if (title.find(micro) != std::string_view::npos) return "us";
    const std::size_t begin = title.find_last_of("[(_/");
    if (begin == std::string_view::npos) return "";
    std::string_view unit = without_blanks(title.substr(begin + 1));
    if (unit.ends_with(']') || unit.ends_with(')')) unit.remove_suffix(1);
    unit = without_blanks(unit);
    if (unit == "sec" || unit == "seconds") return "s";
    if (unit == "nsec" || unit == "nanoseconds") return "ns";
    for (const IndexUnit& known : index_units)
        if (unit == known.name) return std::string(unit);
    return "";
}

tl::expected<TimeNs, std::string> index_time_ns(std::string_view field, std::string_view unit) {
    constexpr std::size_t ns_digits = 19, s_digits = 10;
    const auto point = field.find('.');
    const bool has_point = point != std::string_view::npos;
    const std::string_view whole = field.substr(0, point);
    const std::string_view fraction = has_point ? field.substr(point + 1) : std::string_view();
    if (!are_digits(whole) || (has_point && !are_digits(fraction)))
        return tl::make_unexpected(std::string("a time must be written in digits, e.g. 1403636579763555584"));
    if (unit.empty()) {
        if (!has_point && whole.size() == ns_digits && whole.front() != '0') {
            unit = "ns";
        } else if (has_point && whole.size() == s_digits && whole.front() != '0') {
            unit = "s";
        } else {
            return tl::make_unexpected(std::string(
                "the time's unit is not known: ns since 1970 have 19 digits, seconds since 1970 have 10 and "
                "decimals; allowed for others: a first line that names it, as timestamp [ns],filename, or "
                "[us], [ms], [s]"));
        }
    }
    if (unit == "ns" && fraction.find_first_not_of('0') != std::string_view::npos)
        return tl::make_unexpected(
            std::string("a time in ns is a whole number; allowed for others: a first line that names the "
                        "unit, [us], [ms], [s]"));
    for (const IndexUnit& known : index_units)
        if (known.name == unit)
            if (const auto time_ns = in_ns(whole, fraction, known.decimals)) return *time_ns;
    return tl::make_unexpected(fmt::format("as {} it is no time in ns of 64 bits", unit));
}

}  // namespace fidservo
