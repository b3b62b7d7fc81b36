// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/live/live_board.h"
#include "tests/live/shown_run.h"

#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo {
namespace {

using nlohmann::json;

TEST(Mailbox, NobodyTakesInTime_TheNewestIsThere) {
    Mailbox<int> box;
    EXPECT_EQ(box.take(), nullptr);
    box.put(std::make_unique<int>(1));
    box.put(std::make_unique<int>(2));
    EXPECT_EQ(*box.take(), 2);
    EXPECT_TRUE(box.is_empty());
}

TEST(Mailbox, TwoThreads_ValuesComeWholeAndInOrder) {
    struct Pair {
        int first, second;
    };
    constexpr int last = 200'000;
    Mailbox<Pair> box;
    std::thread producer([&] {
        for (int k = 1; k <= last; ++k) box.put(std::make_unique<Pair>(k, -k));
    });
    int seen = 0;
    while (seen < last)
        if (const auto pair = box.take()) {
            ASSERT_GT(pair->first, seen);
            ASSERT_EQ(pair->second, -pair->first);
            seen = pair->first;
        }
    producer.join();
}

TEST(LiveFeed, NobodyLooks_TheRunGoesOnAndTheOldestPointsStay) {
    LiveFeed feed;
    StageRow row;
    for (int k = 0; k < 1'000'000; ++k) {
        row.time_ns = k;
        feed.tick(row);
    }
    std::vector<StageRow> points;
    feed.take_points(points);
    ASSERT_EQ(points.size(), 1U << 14);
    EXPECT_EQ(points[0].time_ns, LiveFeed::ticks_per_point - 1);
    EXPECT_EQ(points[1].time_ns, 2 * LiveFeed::ticks_per_point - 1);
}

TEST(LiveFeed, Tags_BelongToTheFrameBefore) {
    LiveFeed feed;
    feed.found(testing::tag_on_square(1));
    EXPECT_EQ(feed.take_picture(), nullptr) << "no frame yet";
    feed.saw(testing::frame_with_square(5));
    EXPECT_EQ(feed.take_picture(), nullptr) << "not looked at yet";
    feed.found(testing::tag_on_square(2));
    const auto picture = feed.take_picture();
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->frame.time_ns, 5);
    EXPECT_EQ(picture->tags.at(0).tag_id, 2);
}

TEST(LiveBoard, News_AreToldOnceToEverybody) {
    const auto feed = std::make_shared<LiveFeed>();
    LiveBoard board(feed, reference_rig());
    LiveBoard::Told one, other;
    EXPECT_EQ(board.news(one, 0.0), "");
    testing::show_run(*feed);
    board.collect();
    for (LiveBoard::Told* told : {&one, &other}) {
        const json news = json::parse(board.news(*told, 0.0));
        EXPECT_EQ(news.at("points").size(), 1000U);
        EXPECT_NEAR(news.at("points").at(999).at(1).get<double>(), 120.0, 1e-6) << "2400 counts of 50 um";
        EXPECT_EQ(news.at("picture").at("tags").at(0).at("id"), 12);
        EXPECT_EQ(news.at("state").at("sites").size(), 3U);
        EXPECT_EQ(board.news(*told, 0.0), "");
    }
    feed->is_at({"Demo plate", "site 13", "", {}});
    board.collect();
    const json news = json::parse(board.news(one, 0.0));
    EXPECT_EQ(news.at("points").size(), 0U);
    EXPECT_FALSE(news.contains("picture"));
    EXPECT_EQ(news.at("state").at("activity"), "site 13");
    EXPECT_EQ(board.picture()->substr(0, 3), "\xff\xd8\xff") << "a JPEG";
}

}  // namespace
}  // namespace fidservo
