// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of windows that count, for windows of different lengths.
#include "gap/fit/counted_rows.h"

#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

const std::vector<Window> of_three_lengths{
    {.run = 0, .begin = 0, .end = 2}, {.run = 1, .begin = 2, .end = 5}, {.run = 2, .begin = 5, .end = 6}};

}  // namespace

TEST(CountedRows, OfSomeWindows_AreTheirErrorsOneAfterTheOther) {
    const CountedRows rows(of_three_lengths, {1, 0, 1});
    EXPECT_EQ(rows.of({0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F}), (Errors{0.0F, 1.0F, 5.0F}));
    ASSERT_EQ(rows.windows().size(), 2U);
    EXPECT_EQ(rows.windows()[0].begin, 0U);
    EXPECT_EQ(rows.windows()[0].end, 2U);
    EXPECT_EQ(rows.windows()[1].run, 2U);
    EXPECT_EQ(rows.windows()[1].begin, 2U);
    EXPECT_EQ(rows.windows()[1].end, 3U);
}

TEST(CountedRows, FlagsOfAllWindows_AreThoseOfTheCountedOnes) {
    EXPECT_EQ(CountedRows(of_three_lengths, {1, 0, 1}).flags_of({0, 1, 1}), (Wanted{0, 1}));
}

TEST(CountedRows, OfWhatThePlantRefused_AreNone) {
    EXPECT_TRUE(CountedRows(of_three_lengths, {1, 1, 1}).of({}).empty());
}

}  // namespace fidservo
