// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/ordered_work.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

auto count_to(int last) {
    return [last, next = 0]() mutable -> std::optional<int> {
        if (next == last) return std::nullopt;
        return next++;
    };
}

/// Takes longer for some items, so that threads overtake each other.
int square_slowly(int i) {
    std::this_thread::sleep_for(std::chrono::microseconds((i * 37) % 300));
    return i * i;
}

TEST(RunInOrder, ResultsOfUnevenWork_ComeInOrder) {
    for (const unsigned threads : {1u, 2u, 7u}) {
        std::vector<int> taken;
        run_in_order(
            count_to(500), [] { return square_slowly; }, [&](int result) { taken.push_back(result); },
            threads);
        ASSERT_EQ(taken.size(), 500u) << threads;
        for (int i = 0; i < 500; ++i) ASSERT_EQ(taken[static_cast<std::size_t>(i)], i * i);
    }
}

TEST(RunInOrder, NothingToDo_Ends) {
    int taken = 0;
    run_in_order(
        count_to(0), [] { return square_slowly; }, [&](int) { ++taken; }, 4);
    EXPECT_EQ(taken, 0);
}

TEST(RunInOrder, WorkThatThrows_IsThrownAfterTheResultsBeforeIt) {
    int taken = 0;
    const auto run = [&] {
        run_in_order(
            count_to(200),
            [] {
                return [](int i) {
                    if (i >= 60) throw std::runtime_error(std::to_string(i));
                    return square_slowly(i);
                };
            },
            [&](int) { ++taken; }, 4);
    };
    try {
        run();
        FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "60");
    }
    EXPECT_EQ(taken, 60);
}

TEST(RunInOrder, SourceThatThrows_IsThrown) {
    const auto next = [i = 0]() mutable -> std::optional<int> {
        if (i == 5) throw std::runtime_error("source");
        return i++;
    };
    int taken = 0;
    EXPECT_THROW(run_in_order(
                     next, [] { return square_slowly; }, [&](int) { ++taken; }, 3),
                 std::runtime_error);
    EXPECT_EQ(taken, 5);
}

}  // namespace
}  // namespace fidservo
