// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/counted_rows.h"

#include <algorithm>

namespace fidservo::gap {

CountedRows::CountedRows(std::span<const Window> windows, const Wanted& counted) {
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (counted[w] == 0) continue;
        Window window = windows[w];
        places_.push_back(w);
        begins_.push_back(window.begin);
        window.begin = rows_;
        rows_ += windows[w].end - windows[w].begin;
        window.end = rows_;
        windows_.push_back(window);
    }
}

Errors CountedRows::of(const Errors& errors) const {
    if (errors.empty()) return {};
    Errors of_counted(rows_);
    for (std::size_t w = 0; w < windows_.size(); ++w)
        std::copy_n(errors.begin() + static_cast<std::ptrdiff_t>(begins_[w]),
                    windows_[w].end - windows_[w].begin,
                    of_counted.begin() + static_cast<std::ptrdiff_t>(windows_[w].begin));
    return of_counted;
}

Wanted CountedRows::flags_of(const Wanted& flags) const {
    Wanted of_counted;
    of_counted.reserve(places_.size());
    for (const std::size_t place : places_) of_counted.push_back(flags[place]);
    return of_counted;
}

}  // namespace fidservo::gap
