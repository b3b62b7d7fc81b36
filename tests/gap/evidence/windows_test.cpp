// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/windows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

constexpr double tick_s = 1e-3;

Recording ticking(std::size_t rows) {
    Recording recording;
    recording.tick_s = tick_s;
    for (std::size_t k = 0; k < rows; ++k)
        recording.rows.push_back({.time_ns = static_cast<TimeNs>(k) * ns_per_ms});
    return recording;
}

auto rows_are(std::size_t first, std::size_t end) {
    return AllOf(Field(&Stretch::first, first), Field(&Stretch::end, end));
}

auto window_is(std::size_t lead, std::size_t first, std::size_t end) {
    return AllOf(Field(&WindowRows::lead, lead), Field(&WindowRows::first, first),
                 Field(&WindowRows::end, end));
}

TEST(Windows, UnusableAndMissingRows_EndAStretch) {
    Recording recording = ticking(100);
    std::vector<bool> usable(100, true);
    usable[20] = false;
    for (std::size_t k = 60; k < 100; ++k) recording.rows[k].time_ns += 2 * ns_per_ms;
    EXPECT_THAT(stretches(recording, usable),
                ElementsAre(rows_are(0, 20), rows_are(21, 60), rows_are(60, 100)));
    EXPECT_THAT(stretches(ticking(0), {}), IsEmpty());
}

TEST(Windows, OneSecondEach_TheRestWhereItIsLongEnough) {
    EXPECT_THAT(
        cut({10, 2410}, tick_s, LeadIn::estimates_state),
        ElementsAre(window_is(10, 110, 1110), window_is(1010, 1110, 2110), window_is(2010, 2110, 2410)));
    EXPECT_THAT(cut({10, 2409}, tick_s, LeadIn::estimates_state),
                ElementsAre(window_is(10, 110, 1110), window_is(1010, 1110, 2110)));
    EXPECT_THAT(cut({10, 1010}, tick_s, LeadIn::none), ElementsAre(window_is(10, 10, 1010)));
    EXPECT_THAT(cut({0, 200}, tick_s, LeadIn::estimates_state), IsEmpty());
}

}  // namespace

}  // namespace fidservo
