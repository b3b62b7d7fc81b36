// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/log.h"

#include "src/identify/column_units.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

bool is_of_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// The index in brackets at the end of a column's name, "[2]"; else empty.
std::string_view index_of_name(std::string_view name) {
    const auto open = name.rfind('[');
    const bool is_index = open != std::string_view::npos && name.ends_with(']') &&
                          is_of_digits(name.substr(open + 1, name.size() - open - 2));
    return is_index ? name.substr(open) : std::string_view();
}

/// The name as it is without a unit in brackets at its end, before an index if it has one.
std::string without_unit(const std::string& name) {
    const std::string index(index_of_name(name));
    const std::string whole = name.substr(0, name.size() - index.size());
    const std::string last = whole.substr(whole.rfind('/') + 1);
    const std::string plain = title_parts(last).name;
    const bool is_at_end =
        !last.empty() && std::string_view("])}>").find(last.back()) != std::string_view::npos;
    if (!is_at_end || unit_of_name(last).empty() || plain.empty() || !last.starts_with(plain)) return name;
    return whole.substr(0, whole.size() - last.size()) + plain + index;
}

}  // namespace

const LoggedSignal* Log::find(const std::string& signal) const {
    const auto found = std::ranges::find(signals, signal, &LoggedSignal::name);
    return found == signals.end() ? nullptr : &*found;
}

std::string too_many_numbers(std::uint64_t count) {
    return fmt::format(
        "is passed over: with its {} numbers the file would have more than the {} that are read from one",
        count, most_values);
}

std::string with_visible_controls(std::string_view text) {
    constexpr unsigned char first_of_c1 = 0xC2, low_c1 = 0x80, high_c1 = 0x9F;  // as UTF-8 writes them
    std::string visible;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto byte = static_cast<unsigned char>(text[k]);
        const auto next = static_cast<unsigned char>(k + 1 < text.size() ? text[k + 1] : 0);
        const bool is_c1 = byte == first_of_c1 && next >= low_c1 && next <= high_c1;
        const bool is_control = (byte < ' ' && byte != '\t') || byte == '\x7F' || is_c1;
        if (is_control)
            visible += fmt::format("\\x{:02X}", is_c1 ? next : byte);
        else
            visible += text[k];
        if (is_c1) ++k;
    }
    return visible;
}

std::string unit_of_name(std::string_view name) {
    std::string unit = title_parts(name).unit;
    return is_of_digits(unit) ? std::string() : unit;
}

void take_units_off_names(Log& log) {
    const auto name_of = [](const LoggedSignal& signal) {
        return signal.fault.empty() ? without_unit(signal.name) : signal.name;
    };
    std::map<std::string, int> uses;
    for (const LoggedSignal& signal : log.signals) ++uses[name_of(signal)];
    std::map<std::string, std::string> renamed;
    for (LoggedSignal& signal : log.signals) {
        std::string name = name_of(signal);
        if (name == signal.name || uses.at(name) > 1) continue;
        renamed[signal.name] = name;
        signal.name = std::move(name);
    }
    for (LoggedSignal& signal : log.signals)
        if (const auto times = renamed.find(signal.times); times != renamed.end())
            signal.times = times->second;
}

void add_columns(Log& log, const LoggedSignal& like, std::size_t rows, std::size_t columns,
                 const std::function<void(LoggedSignal&, std::size_t row, std::size_t column)>& append) {
    for (std::size_t column = 0; column < columns; ++column) {
        LoggedSignal signal = like;
        if (columns > 1) signal.name = fmt::format("{}[{}]", like.name, column + 1);
        signal.values.reserve(rows);
        for (std::size_t row = 0; row < rows; ++row) append(signal, row, column);
        log.signals.push_back(std::move(signal));
    }
}

}  // namespace fidservo::imports
