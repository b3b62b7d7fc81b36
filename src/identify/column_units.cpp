// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/column_units.h"

#include <algorithm>
#include <array>

namespace fidservo {

namespace {

constexpr std::array units{
    Unit{"mm", "length", 1.0},        Unit{"um", "length", 1e-3},    Unit{"nm", "length", 1e-6},
    Unit{"cm", "length", 10.0},       Unit{"m", "length", 1e3},      Unit{"V", "voltage", 1.0},
    Unit{"mV", "voltage", 1e-3},      Unit{"uV", "voltage", 1e-6},   Unit{"s", "time", 1.0},
    Unit{"ms", "time", 1e-3},         Unit{"us", "time", 1e-6},      Unit{"ns", "time", 1e-9},
    Unit{"min", "time", 60.0},        Unit{"h", "time", 3600.0},     Unit{"day", "time", 86400.0},
    Unit{"degC", "temperature", 1.0}, Unit{"count", "reading", 1.0}, Unit{"adc", "reading", 1.0}};

struct OtherSpelling {
    std::string_view text;  ///< in small letters
    std::string_view name;
};

constexpr std::array spellings{OtherSpelling{"micron", "um"},
                               OtherSpelling{"microns", "um"},
                               OtherSpelling{"micrometer", "um"},
                               OtherSpelling{"micrometers", "um"},
                               OtherSpelling{"micrometre", "um"},
                               OtherSpelling{"millimeter", "mm"},
                               OtherSpelling{"millimeters", "mm"},
                               OtherSpelling{"millimetre", "mm"},
                               OtherSpelling{"millimetres", "mm"},
                               OtherSpelling{"meter", "m"},
                               OtherSpelling{"meters", "m"},
                               OtherSpelling{"metre", "m"},
                               OtherSpelling{"metres", "m"},
                               OtherSpelling{"volt", "V"},
                               OtherSpelling{"volts", "V"},
                               OtherSpelling{"millivolt", "mV"},
                               OtherSpelling{"millivolts", "mV"},
                               OtherSpelling{"sec", "s"},
                               OtherSpelling{"secs", "s"},
                               OtherSpelling{"second", "s"},
                               OtherSpelling{"seconds", "s"},
                               OtherSpelling{"msec", "ms"},
                               OtherSpelling{"millisecond", "ms"},
                               OtherSpelling{"milliseconds", "ms"},
                               OtherSpelling{"usec", "us"},
                               OtherSpelling{"microsecond", "us"},
                               OtherSpelling{"microseconds", "us"},
                               OtherSpelling{"nsec", "ns"},
                               OtherSpelling{"nanosecond", "ns"},
                               OtherSpelling{"nanoseconds", "ns"},
                               OtherSpelling{"minutes", "min"},
                               OtherSpelling{"hour", "h"},
                               OtherSpelling{"hours", "h"},
                               OtherSpelling{"days", "day"},
                               OtherSpelling{"\xC2\xB0"
                                             "c",
                                             "degC"},
                               OtherSpelling{"\xC2\xBA"
                                             "c",
                                             "degC"},
                               OtherSpelling{"deg c", "degC"},
                               OtherSpelling{"degc", "degC"},
                               OtherSpelling{"celsius", "degC"},
                               OtherSpelling{"counts", "count"}};

/// Of quantities that no command reads; a column that has one of these is not taken for another.
constexpr std::array<std::string_view, 40> other_units{"N",
                                                       "kN",
                                                       "mN",
                                                       "A",
                                                       "mA",
                                                       "Pa",
                                                       "kPa",
                                                       "MPa",
                                                       "hPa",
                                                       "bar",
                                                       "mbar",
                                                       "kg",
                                                       "g",
                                                       "Hz",
                                                       "kHz",
                                                       "MHz",
                                                       "rad",
                                                       "mrad",
                                                       "deg",
                                                       "W",
                                                       "mW",
                                                       "kW",
                                                       "K",
                                                       "rpm",
                                                       "Nm",
                                                       "N.m",
                                                       "%",
                                                       "in",
                                                       "inch",
                                                       "ft",
                                                       "degF",
                                                       "\xC2\xB0"
                                                       "F",
                                                       "\xC2\xB0",
                                                       "m/s",
                                                       "mm/s",
                                                       "um/s",
                                                       "m/s^2",
                                                       "J",
                                                       "Ohm",
                                                       "dB"};

/// With u for the two signs of micro, U+00B5 and U+03BC.
std::string with_plain_micro(std::string_view text) {
    std::string plain(text);
    for (const std::string_view micro : {"\xC2\xB5", "\xCE\xBC"})
        if (const auto at = plain.find(micro); at != std::string::npos) plain.replace(at, micro.size(), "u");
    return plain;
}

std::string_view without_blanks_or_marks(std::string_view text) {
    const auto first = text.find_first_not_of(" \t#");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

constexpr std::array<std::string_view, 4> brackets{"[]", "()", "{}", "<>"};

/// Text in a pair of brackets, and where these stand.
struct Bracketed {
    std::size_t begin, end;
    std::string_view inner;
};

std::vector<Bracketed> all_bracketed(std::string_view text) {
    std::vector<Bracketed> found;
    for (const std::string_view pair : brackets)
        for (std::size_t open = text.find(pair[0]); open != std::string_view::npos;
             open = text.find(pair[0], open + 1)) {
            const std::size_t close = text.find(pair[1], open);
            if (close == std::string_view::npos) break;
            found.push_back(
                {open, close + 1, without_blanks_or_marks(text.substr(open + 1, close - open - 1))});
        }
    return found;
}

}  // namespace

std::string in_small_letters(std::string text) {
    std::ranges::transform(text, text.begin(), [](char a) {
        return a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a;
    });
    return text;
}

const Unit* find_unit(std::string_view text) {
    const std::string plain = with_plain_micro(text);
    const auto by_name = std::ranges::find(units, plain, &Unit::name);
    if (by_name != units.end()) return &*by_name;
    const auto other = std::ranges::find(spellings, in_small_letters(plain), &OtherSpelling::text);
    return other == spellings.end() ? nullptr : &*std::ranges::find(units, other->name, &Unit::name);
}

std::vector<std::string_view> units_of(std::string_view quantity) {
    std::vector<std::string_view> names;
    for (const Unit& unit : units)
        if (unit.quantity == quantity) names.push_back(unit.name);
    return names;
}

std::vector<std::string> units_named_in(std::string_view line) {
    std::vector<std::string> named;
    const auto add = [&](std::string_view text) {
        if (std::string unit = unit_alone(text);
            !unit.empty() && std::ranges::find(named, unit) == named.end())
            named.push_back(std::move(unit));
    };
    for (const Bracketed& piece : all_bracketed(line)) add(piece.inner);
    const bool speaks_of_units = in_small_letters(std::string(line)).find("unit") != std::string::npos;
    const std::string_view separators = speaks_of_units ? ",;|\t:= " : ",;|\t:=";
    while (!line.empty()) {
        const std::size_t end = std::min(line.find_first_of(separators), line.size());
        add(line.substr(0, end));
        line.remove_prefix(std::min(end + 1, line.size()));
    }
    return named;
}

std::string unit_alone(std::string_view text) {
    text = without_blanks_or_marks(text);
    for (const Bracketed& piece : all_bracketed(text))
        if (piece.begin == 0 && piece.end == text.size() && !piece.inner.empty()) {
            text = piece.inner;
            break;
        }
    if (const Unit* unit = find_unit(text)) return std::string(unit->name);
    return std::ranges::find(other_units, text) == other_units.end() ? "" : std::string(text);
}

ColumnTitleParts title_parts(std::string_view title) {
    title = without_blanks_or_marks(title);
    const auto parts = [&](std::size_t name_end, std::string unit) {
        return ColumnTitleParts{std::string(without_blanks_or_marks(title.substr(0, name_end))),
                                std::move(unit), ""};
    };
    const std::vector<Bracketed> pieces = all_bracketed(title);
    for (const Bracketed& piece : pieces)
        if (piece.end == title.size() && title[piece.begin] == '[' && !piece.inner.empty()) {
            const Unit* known = find_unit(piece.inner);
            return parts(piece.begin, std::string(known != nullptr ? known->name : piece.inner));
        }
    for (const Bracketed& piece : pieces)
        if (std::string unit = unit_alone(piece.inner); !unit.empty())
            return piece.begin > 0
                       ? parts(piece.begin, std::move(unit))
                       : ColumnTitleParts{std::string(without_blanks_or_marks(title.substr(piece.end))),
                                          std::move(unit), ""};
    for (const std::string_view before : {"/", ",", " in "})
        for (std::size_t at = title.find(before); at != std::string_view::npos && at > 0;
             at = title.find(before, at + 1))
            if (std::string unit = unit_alone(title.substr(at + before.size())); !unit.empty())
                return parts(at, std::move(unit));
    const auto last = title.find_last_of("_. \t");
    if (last == std::string_view::npos || last == 0) return parts(title.size(), "");
    const std::string_view word = title.substr(last + 1);
    const Unit* known = find_unit(word);
    if (known == nullptr) return parts(title.size(), "");
    // Behind a blank a whole word may be part of the name, as in "laser micrometer" and "x min".
    const bool is_symbol = known->name == with_plain_micro(word) && known->name != "min";
    if (known->name.size() > 1 && (title[last] == '_' || is_symbol))
        return {std::string(title), std::string(known->name), ""};
    return {std::string(title), "", std::string(known->name)};
}

}  // namespace fidservo
