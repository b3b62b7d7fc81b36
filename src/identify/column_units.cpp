// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/column_units.h"

#include <algorithm>
#include <array>

namespace fidservo {

namespace {

constexpr std::array units{
    Unit{"mm", "length", 1.0},   Unit{"um", "length", 1e-3},       Unit{"nm", "length", 1e-6},
    Unit{"cm", "length", 10.0},  Unit{"m", "length", 1e3},         Unit{"V", "voltage", 1.0},
    Unit{"mV", "voltage", 1e-3}, Unit{"uV", "voltage", 1e-6},      Unit{"s", "time", 1.0},
    Unit{"ms", "time", 1e-3},    Unit{"us", "time", 1e-6},         Unit{"ns", "time", 1e-9},
    Unit{"min", "time", 60.0},   Unit{"degC", "temperature", 1.0}, Unit{"count", "reading", 1.0},
    Unit{"adc", "reading", 1.0}};

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

std::string in_small_letters(std::string text) {
    std::ranges::transform(text, text.begin(), [](char a) {
        return a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a;
    });
    return text;
}

std::string_view without_blanks_or_marks(std::string_view text) {
    const auto first = text.find_first_not_of(" \t#");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Text in a pair of brackets at the end of a title, and where they open.
std::string_view bracketed(std::string_view title, char open, char close, std::size_t& begin) {
    if (!title.ends_with(close)) return {};
    begin = title.rfind(open);
    if (begin == std::string_view::npos) return {};
    return without_blanks_or_marks(title.substr(begin + 1, title.size() - begin - 2));
}

}  // namespace

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

bool names_a_unit(std::string_view line) {
    for (std::size_t open = line.find_first_of("[("); open != std::string_view::npos;
         open = line.find_first_of("[(", open + 1)) {
        const std::size_t close = line.find_first_of("])", open);
        if (close != std::string_view::npos && !unit_alone(line.substr(open + 1, close - open - 1)).empty())
            return true;
    }
    return false;
}

std::string unit_alone(std::string_view text) {
    text = without_blanks_or_marks(text);
    std::size_t begin = 0;
    for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}})
        if (const std::string_view inner = bracketed(text, open, close, begin); !inner.empty() && begin == 0)
            text = inner;
    if (const Unit* unit = find_unit(text)) return std::string(unit->name);
    return std::ranges::find(other_units, text) == other_units.end() ? "" : std::string(text);
}

ColumnTitleParts title_parts(std::string_view title) {
    title = without_blanks_or_marks(title);
    const auto parts = [&](std::size_t name_end, std::string unit) {
        return ColumnTitleParts{std::string(without_blanks_or_marks(title.substr(0, name_end))),
                                std::move(unit), ""};
    };
    std::size_t begin = 0;
    if (const std::string_view unit = bracketed(title, '[', ']', begin); !unit.empty()) {
        const Unit* known = find_unit(unit);
        return parts(begin, std::string(known != nullptr ? known->name : unit));
    }
    if (std::string unit = unit_alone(bracketed(title, '(', ')', begin)); !unit.empty())
        return parts(begin, std::move(unit));
    for (std::size_t stroke = title.find('/'); stroke != std::string_view::npos && stroke > 0;
         stroke = title.find('/', stroke + 1))
        if (std::string unit = unit_alone(title.substr(stroke + 1)); !unit.empty())
            return parts(stroke, std::move(unit));
    const auto underscore = title.rfind('_');
    if (underscore == std::string_view::npos || underscore == 0) return parts(title.size(), "");
    const Unit* known = find_unit(title.substr(underscore + 1));
    if (known == nullptr) return parts(title.size(), "");
    if (known->name.size() > 1) return {std::string(title), std::string(known->name), ""};
    return {std::string(title), "", std::string(known->name)};
}

}  // namespace fidservo
