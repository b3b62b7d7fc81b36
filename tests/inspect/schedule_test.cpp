// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/schedule.h"

#include <gtest/gtest.h>

namespace fidservo::inspect {
namespace {

std::vector<Site> sites(std::initializer_list<int> ids) {
    std::vector<Site> list;
    for (const int id : ids) list.push_back({id, {2.0 * id, 0.0}, {}, {}});
    return list;
}

/// Visits until nothing is left; `bad` sites are deferred at their first visit.
std::vector<std::pair<int, bool>> walk(const std::vector<Site>& all, const std::vector<int>& bad) {
    std::vector<Visit> visits;
    std::vector<std::pair<int, bool>> order;
    while (const auto next = next_visit(all, visits)) {
        const bool fails = std::ranges::count(bad, next->site->tag_id) > 0;
        Visit visit{};
        visit.site = next->site->tag_id;
        visit.again = next->again;
        visit.end = !fails ? Visit::End::measured : next->again ? Visit::End::skipped : Visit::End::deferred;
        visits.push_back(visit);
        order.emplace_back(visit.site, visit.again);
    }
    return order;
}

using Order = std::vector<std::pair<int, bool>>;

TEST(Schedule, NothingFails_RecipeOrder) {
    EXPECT_EQ(walk(sites({7, 3, 5}), {}), (Order{{7, false}, {3, false}, {5, false}}));
}

TEST(Schedule, TwoDeferred_ComeOnceMoreAtTheEnd) {
    EXPECT_EQ(walk(sites({7, 3, 5}), {7, 5}),
              (Order{{7, false}, {3, false}, {5, false}, {7, true}, {5, true}}));
}

TEST(Remedy, RetriesThenDefersThenSkips) {
    const OnFailure rule{.retries = 2, .defer = true};
    EXPECT_EQ(remedy_for(rule, 1, false), Remedy::retry);
    EXPECT_EQ(remedy_for(rule, 2, false), Remedy::retry);
    EXPECT_EQ(remedy_for(rule, 3, false), Remedy::defer);
    EXPECT_EQ(remedy_for(rule, 3, true), Remedy::skip);
}

TEST(Remedy, SkipRule_NeverDefers) {
    EXPECT_EQ(remedy_for({.retries = 0, .defer = false}, 1, false), Remedy::skip);
}

}  // namespace
}  // namespace fidservo::inspect
