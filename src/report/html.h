#pragma once
// Small pieces of HTML.
#include <span>
#include <string>
#include <string_view>

namespace fidservo::report {

/// Text made safe between tags and inside quoted attributes.
std::string escaped(std::string_view text);

/// Base64 (RFC 4648, with padding).
std::string base64(std::span<const unsigned char> bytes);

/// A number for people: `digits` after the point, a true minus sign, an en dash where it is not finite.
std::string number(double value, int digits);

}  // namespace fidservo::report
