// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Names of keys: the unit that a key ends with, and the key that was meant by one that does not exist.
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

/// The unit that ends a key, written out: "gain_mm_per_s_per_V" gives "mm/s/V", "kaw_per_s" gives "1/s".
/// Empty if the key names none.
std::string unit_of_key(std::string_view key);

/// One line on a key that is not allowed: the key that was probably meant, or all that are allowed.
std::string explain_unknown_key(std::string_view key, const std::vector<std::string_view>& allowed);

/// The word of the list that differs from `word` by a slip of the pen (edit distance of at most a third of
/// its length, 3 at most); empty if there is none.
std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& words);

}  // namespace fidservo
