// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Numbers in the notations of different countries and instruments: point or comma as the decimal sign.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fidservo {

enum class DecimalSign : std::uint8_t { point, comma };

/// What one written number shows about the decimal sign of its file.
enum class SignEvidence : std::uint8_t {
    none,           ///< 12, -3e5
    point,          ///< 1.5, 1,234.5, 1,234,567: only a number where the point is the decimal sign
    comma,          ///< 1,5, 1.234,5, 1.234.567
    point_or_group  ///< 1.234 or 1,234: one and a quarter, or a thousand and more
};

/// The kind of a field's content.
enum class FieldKind : std::uint8_t {
    empty,   ///< nothing, or a word for nothing: NaN, N/A, --
    number,  ///< a number with at least one of the decimal signs; infinity too
    time,    ///< a time of day, possibly with a date (clock_time.h)
    text
};

struct FieldLook {
    FieldKind kind = FieldKind::text;
    SignEvidence evidence = SignEvidence::none;
    bool has_blank_groups = false;  ///< 1 234: thousands between plain blanks
};

/// Classifies a field, given without quotes around it. Thousands may also be marked by ' and by blanks of any
/// width, an exponent by e or Fortran's d.
FieldLook look_at(std::string_view field);

/// The number with this decimal sign, the other sign separating thousands; empty if the field is no finite
/// number in this notation.
std::optional<double> number_of(std::string_view field, DecimalSign sign);

/// Whether the field says "not a number" or "infinity" in so many words.
bool is_not_finite(std::string_view field);

std::string_view name_of(DecimalSign sign);

}  // namespace fidservo
