// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/text/key_names.h"

#include <algorithm>
#include <array>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

constexpr std::array unit_words{"mm",  "um",  "px", "s",  "ns", "ms",  "V",     "degC",
                                "rad", "deg", "Hz", "hz", "e",  "lsb", "count", "counts"};

bool is_unit_word(std::string_view word) {
    return std::find(unit_words.begin(), unit_words.end(), word) != unit_words.end();
}

std::vector<std::string_view> words_of(std::string_view key) {
    std::vector<std::string_view> words;
    while (true) {
        const auto end = key.find('_');
        words.push_back(key.substr(0, end));
        if (end == std::string_view::npos) return words;
        key.remove_prefix(end + 1);
    }
}

/// Where the unit begins in the words of a key; the first word is never part of it.
std::size_t unit_begin(const std::vector<std::string_view>& words) {
    std::size_t begin = words.size();
    while (begin > 1 && (is_unit_word(words[begin - 1]) || words[begin - 1] == "per")) --begin;
    return words.back() == "per" ? words.size() : begin;
}

std::string stem_of(std::string_view key) {
    const auto words = words_of(key);
    return fmt::format("{}", fmt::join(words.begin(), words.begin() + unit_begin(words), "_"));
}

/// Edits (insert, delete, replace) from one word to another.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0u);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string unit_of_key(std::string_view key) {
    const auto words = words_of(key);
    std::string unit;
    std::string separator;
    for (std::size_t i = unit_begin(words); i < words.size(); ++i) {
        if (words[i] == "per") {
            unit += unit.empty() ? "1/" : "/";
            separator.clear();
        } else {
            unit += separator;
            unit += words[i];
            separator = " ";
        }
    }
    return unit;
}

std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& words) {
    std::string_view nearest;
    std::size_t best = std::min<std::size_t>(3, std::max<std::size_t>(1, word.size() / 3)) + 1;
    for (const std::string_view candidate : words)
        if (const std::size_t distance = edit_distance(word, candidate); distance < best) {
            best = distance;
            nearest = candidate;
        }
    return nearest;
}

std::string explain_unknown_key(std::string_view key, const std::vector<std::string_view>& allowed) {
    const std::string stem = stem_of(key);
    for (const std::string_view candidate : allowed)
        if (stem_of(candidate) == stem) {
            const std::string unit = unit_of_key(candidate);
            return fmt::format("unknown key; did you mean {}{}?", candidate,
                               unit.empty() ? "" : fmt::format(", in {}", unit));
        }
    if (const std::string_view meant = nearest_word(key, allowed); !meant.empty())
        return fmt::format("unknown key; did you mean {}?", meant);
    return fmt::format("unknown key; allowed here: {}", fmt::join(allowed, ", "));
}

}  // namespace fidservo
