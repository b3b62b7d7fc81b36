// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/label.h"

#include <array>

namespace fidservo::selfcheck {

std::string_view name_of(CaseKind kind) {
    constexpr std::array<std::string_view, kind_count> names{
        "none",  "one",   "two",        "withheld", "unlisted", "frames", "frames-none", "frames-withheld",
        "three", "messy", "messy-none", "rough"};
    return names.at(static_cast<std::size_t>(kind));
}

}  // namespace fidservo::selfcheck
