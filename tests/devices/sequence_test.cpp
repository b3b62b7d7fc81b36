// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/sequence.h"

#include <gtest/gtest.h>

namespace fidservo::vision::v4l2 {
namespace {

TEST(SequenceCounter, EveryNumber_NothingMissing) {
    SequenceCounter counter;
    for (std::uint32_t k = 7; k < 12; ++k) EXPECT_EQ(counter.take(k), 0U);
    EXPECT_EQ(counter.sequence(), 4U);
}

TEST(SequenceCounter, Gap_IsCountedAndPassedOn) {
    SequenceCounter counter;
    EXPECT_EQ(counter.take(0), 0U);
    EXPECT_EQ(counter.take(3), 2U);
    EXPECT_EQ(counter.take(4), 0U);
    EXPECT_EQ(counter.take(14), 9U);
    EXPECT_EQ(counter.sequence(), 14U);
}

TEST(SequenceCounter, NumberWraps_GoesOn) {
    SequenceCounter counter;
    EXPECT_EQ(counter.take(0xfffffffeU), 0U);
    EXPECT_EQ(counter.take(1U), 2U) << "0xffffffff and 0 are missing";
    EXPECT_EQ(counter.sequence(), 3U);
}

TEST(SequenceCounter, DriverCountsAnew_NothingMissing) {
    SequenceCounter counter;
    EXPECT_EQ(counter.take(100), 0U);
    EXPECT_EQ(counter.take(0), 0U);
    EXPECT_EQ(counter.take(0), 0U) << "a driver that does not count";
    EXPECT_EQ(counter.sequence(), 2U);
    counter.restart();
    EXPECT_EQ(counter.take(50), 0U);
    EXPECT_EQ(counter.sequence(), 3U);
}

}  // namespace
}  // namespace fidservo::vision::v4l2
