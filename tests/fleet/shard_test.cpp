// SPDX-License-Identifier: GPL-3.0-or-later
// Shares of tasks, and the names of results.
#include "src/fleet/shard.h"

#include "src/fleet/stretch.h"
#include "src/fleet/task_name.h"
#include "tests/src/message_of.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::fleet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;

TEST(Shard, AnyNumberOfShares_HasEachTaskOnce) {
    for (const std::size_t of : {1U, 2U, 3U, 7U, 16U, 40U}) {
        std::vector<std::size_t> all;
        for (std::size_t number = 1; number <= of; ++number)
            for (const std::size_t task : tasks_of({number, of}, 23)) all.push_back(task);
        std::ranges::sort(all);
        ASSERT_EQ(all.size(), 23U) << of;
        for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[k], k) << of;
    }
    EXPECT_THAT(tasks_of({3, 4}, 8), ElementsAre(2U, 6U));
}

TEST(Shard, Text_IsKOfN) {
    const Shard shard = parse_shard("3/16");
    EXPECT_EQ(shard.number, 3U);
    EXPECT_EQ(shard.of, 16U);
    for (const char* wrong : {"", "3", "0/4", "5/4", "-1/4", "1/0", "1/4x", " 1/4", "1//4", "a/b"})
        EXPECT_THAT(message_of([&] { parse_shard(wrong); }),
                    HasSubstr(std::string("--shard: ") + wrong + ": must be K/N"));
}

TEST(TaskName, Path_IsNotedAsGivenAndSaysNothingOfTheMachine) {
    EXPECT_EQ(noted_path("recordings/unit-07/2026-W45"), "recordings/unit-07/2026-W45");
    EXPECT_EQ(noted_path("./recordings//unit-07/"), "recordings/unit-07");
    EXPECT_EQ(noted_path("../unit"), "../unit");
    EXPECT_EQ(noted_path("."), ".");
    EXPECT_EQ(noted_path("/mnt/lab/recordings/unit-07/W45/"), "unit-07/W45");
    EXPECT_EQ(noted_path("/W45"), "W45");
}

TEST(TaskName, Stem_IsAnotherOneForAnyOtherPath) {
    EXPECT_EQ(file_stem("recordings/unit-07/2026-W45"), "recordings+unit-07+2026-W45");
    EXPECT_EQ(file_stem("../a b+c"), "%2E.+a%20b%2Bc");
    const std::string long_path(300, 'x');
    EXPECT_LT(file_stem(long_path).size(), 140U);
    const std::vector<std::string> paths{"a/b",  "a+b",     "a%2Fb",         "a_b",           "a",
                                         "./a+", long_path, long_path + "x", "x" + long_path, "a b"};
    std::set<std::string> stems;
    for (const std::string& path : paths) stems.insert(file_stem(path));
    EXPECT_EQ(stems.size(), paths.size() - (long_path + "x" == "x" + long_path ? 1 : 0));
}

TEST(Stretch, Series_AreCutByThemselvesAndSingleImagesTakenTogether) {
    std::vector<ImageFrames::Series> series{{"photos", 2500, false}, {"film.mkv", 12'000, true}};
    for (int k = 0; k < 1001; ++k) series.push_back({"single.png", 1, false});
    const std::vector<Stretch> stretches = stretches_of(series);
    ASSERT_EQ(stretches.size(), 7U);
    const auto is = [&](std::size_t k, std::size_t of, std::size_t first, std::size_t count, bool is_open) {
        EXPECT_EQ(stretches[k].series, of) << k;
        EXPECT_EQ(stretches[k].first, first) << k;
        EXPECT_EQ(stretches[k].count, count) << k;
        EXPECT_EQ(stretches[k].is_open, is_open) << k;
    };
    is(0, 0, 0, 1000, false);
    is(1, 0, 1000, 1000, false);
    is(2, 0, 2000, 500, false);
    is(3, 1, 0, 10'000, false);
    is(4, 1, 10'000, 2000, true);
    is(5, 2, 0, 1000, false);
    is(6, 1002, 0, 1, false);
    EXPECT_EQ(stretches[1].stem(), "photos+0001000");
}

}  // namespace
}  // namespace fidservo::fleet
