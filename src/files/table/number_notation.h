// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Numbers as different countries and instruments write them: which of point and comma is the decimal sign.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fidservo {

enum class DecimalSign : std::uint8_t { point, comma };

/// What one written number tells about the decimal sign of its file.
enum class SignEvidence : std::uint8_t {
    none,           ///< 12, -3e5
    point,          ///< 1.5, 1,234.5, 1,234,567: only a number where the point is the decimal sign
    comma,          ///< 1,5, 1.234,5, 1.234.567
    point_or_group  ///< 1.234 or 1,234: one and a quarter, or a thousand and more
};

/// What stands in a field.
enum class FieldKind : std::uint8_t {
    empty,   ///< nothing, or a word for nothing: NaN, N/A, --
    number,  ///< by one of the decimal signs at least; infinity too
    time,    ///< of day, perhaps of a date (clock_time.h)
    text
};

struct FieldLook {
    FieldKind kind = FieldKind::text;
    SignEvidence evidence = SignEvidence::none;
    bool has_blank_groups = false;  ///< 1 234: thousands between plain blanks
};

/// Looks at a field without quotes around it. Thousands may also be marked by ' and by blanks of any width,
/// an exponent by e or Fortran's d.
FieldLook look_at(std::string_view field);

/// The number that is written, the other of the two signs being a mark between thousands; empty if it is none
/// under this sign, or not finite.
std::optional<double> number_of(std::string_view field, DecimalSign sign);

/// Whether the field says "not a number" or "infinity" in so many words.
bool is_not_finite(std::string_view field);

std::string_view name_of(DecimalSign sign);

}  // namespace fidservo
