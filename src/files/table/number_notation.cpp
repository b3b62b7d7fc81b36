// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/number_notation.h"

#include "src/files/table/clock_time.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

namespace fidservo {

namespace {

constexpr std::array<std::string_view, 16> words_for_nothing{
    "nan", "-nan", "+nan", "n/a", "na", "#n/a", "null",    "none",
    "-",   "--",   "---",  "*",   "**", "***",  "1.#qnan", "-1.#ind"};
constexpr std::array<std::string_view, 8> words_for_infinity{"inf",       "+inf",      "-inf",   "infinity",
                                                             "+infinity", "-infinity", "1.#inf", "-1.#inf"};

bool is_one_of(std::string_view field, auto words) {
    return std::ranges::any_of(words, [&](std::string_view word) {
        return std::ranges::equal(field, word, [](char a, char b) {
            return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
        });
    });
}

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

/// Marks between thousands that cannot be a decimal sign: ', and blanks: plain, no-break (U+00A0, U+202F),
/// thin (U+2009); U+2019 is a curved '.
constexpr std::array<std::string_view, 6> neutral_marks{
    "'", " ", "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89", "\xE2\x80\x99"};

struct Piece {
    char mark;  ///< in front of the digits: 0 none, '.', ',', or '_' for a neutral one
    std::string_view digits;
};

/// A number's parts; the first piece has the digits in front of any mark.
struct Parts {
    static constexpr std::size_t most = 12;
    bool is_negative = false;
    std::array<Piece, most> storage = {};
    std::size_t count = 0;
    std::string_view exponent = {};  ///< with its sign, without its letter
    bool has_blank_groups = false;

    std::span<const Piece> pieces() const { return std::span(storage).first(count); }
};

std::string_view digits_at(std::string_view text) {
    return text.substr(0, std::min(text.find_first_not_of("0123456789"), text.size()));
}

/// The mark at the front of a text, which is taken off; 0 if there is none.
char take_mark(std::string_view& text, Parts& parts) {
    if (text.starts_with('.') || text.starts_with(',')) {
        const char mark = text.front();
        text.remove_prefix(1);
        return mark;
    }
    for (const std::string_view mark : neutral_marks)
        if (text.starts_with(mark)) {
            parts.has_blank_groups = parts.has_blank_groups || mark == " ";
            text.remove_prefix(mark.size());
            return '_';
        }
    return 0;
}

bool take_exponent(std::string_view& text, Parts& parts) {
    if (text.empty() || std::string_view("eEdD").find(text.front()) == std::string_view::npos) return false;
    std::string_view rest = text.substr(1);
    const bool has_sign = rest.starts_with('+') || rest.starts_with('-');
    const std::string_view digits = digits_at(rest.substr(has_sign ? 1 : 0));
    if (digits.empty()) return false;
    parts.exponent =
        rest.substr(rest.starts_with('+') ? 1 : 0, digits.size() + (rest.starts_with('-') ? 1 : 0));
    text.remove_prefix(1 + (has_sign ? 1 : 0) + digits.size());
    return true;
}

std::optional<Parts> parts_of(std::string_view text) {
    constexpr std::string_view minus = "\xE2\x88\x92";  // U+2212
    constexpr std::size_t longest = 400;
    if (text.size() > longest) return std::nullopt;
    Parts parts;
    if (text.starts_with(minus)) {
        parts.is_negative = true;
        text.remove_prefix(minus.size());
    } else if (text.starts_with('-') || text.starts_with('+')) {
        parts.is_negative = text.front() == '-';
        text.remove_prefix(1);
    }
    char mark = 0;
    do {
        const std::string_view digits = digits_at(text);
        if (parts.count == Parts::most) return std::nullopt;
        parts.storage[parts.count++] = {mark, digits};
        text.remove_prefix(digits.size());
        mark = take_mark(text, parts);
    } while (mark != 0);
    (void)take_exponent(text, parts);
    const bool any_digit =
        std::ranges::any_of(parts.pieces(), [](const Piece& piece) { return !piece.digits.empty(); });
    if (!text.empty() || !any_digit) return std::nullopt;
    return parts;
}

/// Whether pieces 1 to `end` are thousands behind piece 0, all with one mark.
bool are_groups(std::span<const Piece> pieces, std::size_t end) {
    const std::string_view first = pieces[0].digits;
    if (first.empty() || first.size() > 3 || (end > 1 && first.front() == '0')) return end == 1;
    return std::ranges::all_of(pieces.subspan(1, end - 1), [&](const Piece& piece) {
        return piece.digits.size() == 3 && piece.mark == pieces[1].mark;
    });
}

/// Whether the parts are a number whose decimal sign is `sign`.
bool is_number_with(const Parts& parts, char sign) {
    const std::span<const Piece> pieces = parts.pieces();
    const bool has_fraction = pieces.size() > 1 && pieces.back().mark == sign;
    const std::size_t whole = pieces.size() - (has_fraction ? 1 : 0);
    const auto is_sign = [&](const Piece& piece) { return piece.mark == sign; };
    if (std::ranges::any_of(pieces.first(whole), is_sign)) return false;
    if (whole > 1 && !parts.exponent.empty()) return false;
    if (whole > 1 && !are_groups(pieces, whole)) return false;
    // A comma without digits on both sides is punctuation.
    const bool is_bare = pieces.front().digits.empty() || pieces.back().digits.empty();
    return !(has_fraction && sign == ',' && is_bare);
}

SignEvidence evidence_of(bool by_point, bool by_comma, const Parts& parts) {
    if (by_point != by_comma) return by_point ? SignEvidence::point : SignEvidence::comma;
    const bool has_sign = std::ranges::any_of(
        parts.pieces(), [](const Piece& piece) { return piece.mark == '.' || piece.mark == ','; });
    return has_sign ? SignEvidence::point_or_group : SignEvidence::none;
}

}  // namespace

FieldLook look_at(std::string_view field) {
    if (field.empty() || is_one_of(field, words_for_nothing)) return {.kind = FieldKind::empty};
    if (is_one_of(field, words_for_infinity)) return {.kind = FieldKind::number};
    if (const auto parts = parts_of(field)) {
        const bool by_point = is_number_with(*parts, '.'), by_comma = is_number_with(*parts, ',');
        if (by_point || by_comma)
            return {FieldKind::number, evidence_of(by_point, by_comma, *parts), parts->has_blank_groups};
    }
    if (field.size() > 4 && is_digit(field.front()) && clock_time_of(field)) return {.kind = FieldKind::time};
    return {};
}

std::optional<double> number_of(std::string_view field, DecimalSign sign) {
    const auto parts = parts_of(field);
    const char letter = sign == DecimalSign::point ? '.' : ',';
    if (!parts || !is_number_with(*parts, letter)) return std::nullopt;
    std::string plain(parts->is_negative ? "-" : "");
    for (const Piece& piece : parts->pieces()) {
        if (piece.mark == letter) plain += '.';
        plain += piece.digits;
    }
    if (!parts->exponent.empty()) plain.append("e").append(parts->exponent);
    double value = 0.0;
    const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    if (error != std::errc() || end != plain.data() + plain.size()) return std::nullopt;
    return value;
}

bool is_not_finite(std::string_view field) {
    return is_one_of(field, words_for_infinity) ||
           (is_one_of(field, words_for_nothing) && field.find_first_of("nN") != std::string_view::npos);
}

std::string_view name_of(DecimalSign sign) {
    return sign == DecimalSign::point ? "point" : "comma";
}

}  // namespace fidservo
