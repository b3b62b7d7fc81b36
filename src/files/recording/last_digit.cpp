// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/last_digit.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fidservo {

namespace {

/// Decimals of a number as it is written, 0 in 12, 2 in 12.50 and in 125.0e-01; negative in 1e3.
int decimals_of(std::string_view number) {
    constexpr int beyond_any_double = 1000;
    const std::size_t e = number.find_first_of("eE");
    const std::string_view mantissa = number.substr(0, e);
    const std::size_t point = mantissa.find('.');
    const int decimals = point == std::string_view::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
    if (e == std::string_view::npos) return decimals;
    number.remove_prefix(e + 1);
    if (number.starts_with('+')) number.remove_prefix(1);
    int exponent = 0;
    std::from_chars(number.data(), number.data() + number.size(), exponent);
    return decimals - std::clamp(exponent, -beyond_any_double, beyond_any_double);
}

}  // namespace

void LastDigit::saw(std::string_view number) {
    const int decimals = decimals_of(number);
    is_fixed_ = is_fixed_ && (!decimals_ || *decimals_ == decimals);
    decimals_ = decimals;
}

std::optional<double> LastDigit::step() const {
    if (!is_fixed_ || decimals_.value_or(0) < 1) return std::nullopt;
    return std::pow(10.0, -*decimals_);
}

}  // namespace fidservo
