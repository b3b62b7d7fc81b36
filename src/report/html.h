// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Small pieces of HTML.
#include <bit>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::report {

/// Text made safe between tags and inside quoted attributes.
std::string escaped(std::string_view text);

/// Base64 (RFC 4648, with padding).
std::string base64(std::span<const unsigned char> bytes);

/// Numbers as the reports' plots unpack them: their bytes, little-endian, in base64.
template <class Number>
std::string packed(const std::vector<Number>& values) {
    static_assert(std::endian::native == std::endian::little);
    return base64({reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(Number)});
}

/// A number for people: `digits` after the point, a true minus sign, an en dash where it is not finite.
std::string number(double value, int digits);

}  // namespace fidservo::report
