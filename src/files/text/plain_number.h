// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <charconv>
#include <string_view>
#include <system_error>

namespace fidservo {

/// Reads a number that is all of a text, with or without a sign, whatever the locale.
/// @return whether it is one that T holds
template <class T>
bool parse_all(std::string_view text, T& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

}  // namespace fidservo
