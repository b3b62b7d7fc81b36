// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <charconv>
#include <string_view>
#include <system_error>

namespace fidservo {

/// Reads a number that takes up a whole text, with or without a sign, independent of the locale.
/// @return false if it is none, or does not fit into T
template <class T>
bool parse_all(std::string_view text, T& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

}  // namespace fidservo
