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
