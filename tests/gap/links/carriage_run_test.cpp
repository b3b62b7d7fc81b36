// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/carriage_run.h"

#include "core/rig.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

/// A second of readings, one a millisecond.
CarriageRun run_of(const std::function<double(std::size_t)>& count_of_row) {
    Recording recording;
    recording.tick_s = 1e-3;
    for (std::size_t k = 0; k < 1000; ++k)
        recording.rows.push_back({.time_ns = static_cast<TimeNs>(k) * ns_per_ms,
                                  .macro_command_V = 0.0,
                                  .encoder_count = count_of_row(k)});
    return carriage_run(recording, reference_rig().macro);
}

TEST(CarriageRun, SameReadingFor50MsAround_Stands) {
    const CarriageRun run = run_of([](std::size_t k) { return k < 300 ? 2000.0 : 2001.0; });
    EXPECT_TRUE(run.stands[0] && run.stands[249] && run.stands[350] && run.stands[999]);
    EXPECT_FALSE(run.stands[250] || run.stands[300] || run.stands[349]);
}

TEST(CarriageRun, ReadingToAndFroBetweenTwoCounts_Stands) {
    const CarriageRun run = run_of([](std::size_t k) { return 2000.0 + static_cast<double>(k / 30 % 2); });
    EXPECT_TRUE(run.stands[0] && run.stands[500] && run.stands[999]);
}

TEST(CarriageRun, ReadingThatGoesOnCountByCount_DoesNotStand) {
    const CarriageRun run = run_of([](std::size_t k) {
        const std::size_t counts = k / 30;
        return 2000.0 + static_cast<double>(counts);
    });
    EXPECT_FALSE(run.stands[500]);
}

TEST(CarriageRun, SwingOverThreeCounts_DoesNotStand) {
    const CarriageRun run = run_of([](std::size_t k) {
        constexpr double swing[] = {2000.0, 2001.0, 2002.0, 2001.0};
        return swing[k / 30 % 4];
    });
    EXPECT_FALSE(run.stands[500]);
}

}  // namespace

}  // namespace fidservo
