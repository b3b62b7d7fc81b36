// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How exactly a column of a recording is known, by the decimals of its numbers as they are written.
#include <optional>
#include <string_view>

namespace fidservo {

/// The step of a column's last digit, where all its fields have as many decimals. Where zeros are left away,
/// or all numbers are whole, a short number may be as exact as a long one.
class LastDigit {
  public:
    void saw(std::string_view number);
    std::optional<double> step() const;

  private:
    bool is_fixed_ = true;
    std::optional<int> decimals_;
};

}  // namespace fidservo
