// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/budget.h"

#include <atomic>

#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

constexpr auto rows_of_a_second = static_cast<std::uint64_t>(rows_a_second);

TEST(Budget, CountedByEffort_EndsBySecondsThatWereCountedAlone) {
    const Budget budget(2.0, 3.0, {}, Seconds::by_effort);
    budget.check();
    budget.count(2 * rows_of_a_second);
    budget.check();
    budget.count(1);
    EXPECT_THROW(budget.check(), BudgetEnded);
    budget.end_search();
    budget.check();
    budget.count(rows_of_a_second);
    EXPECT_THROW(budget.check(), BudgetEnded);
}

TEST(Budget, ProlongedAfterItsEnd_GoesOnFromThere) {
    const Budget budget(1.0, 1.0, {}, Seconds::by_effort);
    budget.count(10 * rows_of_a_second);
    EXPECT_THROW(budget.check(), BudgetEnded);
    budget.end_search();
    budget.prolong(1.0);
    budget.count(rows_of_a_second);
    budget.check();
    budget.count(1);
    EXPECT_THROW(budget.check(), BudgetEnded);
}

TEST(Budget, ShareOfWhatIsLeft_EndsBeforeTheSearch_AndOnlyWhileItLives) {
    const Budget budget(10.0, 12.0, {}, Seconds::by_effort);
    budget.count(2 * rows_of_a_second);
    {
        const Budget::Share half(budget, 0.5);
        budget.count(4 * rows_of_a_second);
        EXPECT_NO_THROW(budget.check());
        budget.count(1);
        EXPECT_THROW(budget.check(), ShareEnded);
    }
    EXPECT_NO_THROW(budget.check());
    const Budget::Share half(budget, 0.5);
    budget.end_search();
    budget.count(5 * rows_of_a_second);
    EXPECT_NO_THROW(budget.check()) << "what follows the search has no shares";
}

TEST(Budget, OfNoLimit_NeverEnds) {
    const Budget budget;
    const Budget::Share none(budget, 0.0);
    budget.count(1000 * rows_of_a_second);
    EXPECT_NO_THROW(budget.check());
}

TEST(Budget, Interrupted_EndsWhateverIsLeft) {
    std::atomic<bool> interrupted = false;
    const Budget budget(
        100.0, 100.0, [&] { return interrupted.load(); }, Seconds::by_effort);
    budget.check();
    interrupted = true;
    try {
        budget.check();
        FAIL() << "it went on";
    } catch (const BudgetEnded& end) {
        EXPECT_EQ(end.how(), Ended::interrupted);
    }
}

}  // namespace
}  // namespace fidservo::gap
