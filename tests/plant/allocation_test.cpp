// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/stage_plant.h"
#include "tests/plant/allocation_count.h"
#include "tests/plant/reference_rig.h"

#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

TEST(AllocationCount, Allocation_IsCounted) {
    const long before = allocation_count();
    std::vector<int> numbers(100);
    EXPECT_GT(allocation_count(), before) << numbers.size();
}

TEST(StagePlant, Tick_DoesNotAllocate) {
    const StagePlant plant = make_stage_plant(reference_rig());
    StageState state = start(plant, 100.0, 1);
    NoiseStream commands(9, "commands");
    std::int64_t read = 0;
    const long before = allocation_count();
    double micro_V = 1.6;
    for (int k = 0; k < 200000; ++k) {
        if (k % 300 == 0)
            micro_V = 1.3 + 0.6 * commands.uniform();  // many turns: the wire's memory is at work
        read += sample(plant, state).hall_adc;
        advance(plant, state, 10.0 * (commands.uniform() - 0.5), micro_V);
    }
    EXPECT_EQ(allocation_count() - before, 0);
    EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace fidservo::plant
