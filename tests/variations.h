// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tests with many random inputs of one kind: each must be measured right or refused, none silently wrong.
#include <cstdint>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo {

/// What the program did with one input.
struct Outcome {
    enum class End { right, refused, wrong };
    End end;
    std::string text = {};  ///< the error, or the refusal's message

    static Outcome right() { return {End::right}; }
    /// A refusal in one line that states the cause; anything else is wrong.
    static Outcome refused(const std::string& line) {
        const bool one_line = !line.empty() && line.find('\n') == std::string::npos;
        return {one_line ? End::refused : End::wrong, line};
    }
    static Outcome wrong(const std::string& text) { return {End::wrong, text}; }
};

/// Draws `number` inputs of a kind, one for each seed, and prints the kind's row of the table "kind, tried,
/// right, refused, wrong". Every wrong one is printed with its seed; more of them than `most_wrong` fail the
/// test, and so does a kind of which all are refused.
/// @param trial  (std::mt19937_64&) -> Outcome: draws an input, runs the program on it, judges the result
/// @param most_wrong  0 unless a known defect is stated
template <class Trial>
void expect_right_or_refused(const std::string& kind, int number, Trial trial, int most_wrong = 0) {
    int right = 0, refused = 0, wrong = 0;
    for (int seed = 1; seed <= number; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const Outcome outcome = trial(random);
        right += outcome.end == Outcome::End::right ? 1 : 0;
        refused += outcome.end == Outcome::End::refused ? 1 : 0;
        wrong += outcome.end == Outcome::End::wrong ? 1 : 0;
        if (outcome.end == Outcome::End::wrong)
            fmt::print("{}, seed {}: wrong: {}\n", kind, seed, outcome.text);
    }
    fmt::print("variations | {} | tried {} | right {} | refused {} | wrong {}\n", kind, number, right,
               refused, wrong);
    EXPECT_LE(wrong, most_wrong) << kind;
    EXPECT_GT(right, 0) << kind << ": all were refused";
}

}  // namespace fidservo
