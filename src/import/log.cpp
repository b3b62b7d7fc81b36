// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/log.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::imports {

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
