// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/delay_line.h"

#include "core/random.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr double tick_s = 0.001;

std::vector<std::pair<double, double>> pieces_of_tick(DelayLineState& state, double delay_s, double command) {
    std::vector<std::pair<double, double>> pieces;
    pass(state, delay_s, tick_s, command,
         [&](double acting, double duration_s) { pieces.emplace_back(acting, duration_s); });
    return pieces;
}

TEST(DelayLine, Of3700Microseconds_SwitchesWithinTheFourthTick) {
    DelayLineState state = start_delay_line(0.0037, tick_s);
    for (int k = 0; k < 3; ++k) {
        const auto pieces = pieces_of_tick(state, 0.0037, 1.7);
        ASSERT_EQ(pieces.size(), 1U) << k;
        EXPECT_EQ(pieces[0].first, 0.0);
        EXPECT_DOUBLE_EQ(pieces[0].second, tick_s);
    }
    const auto pieces = pieces_of_tick(state, 0.0037, 1.7);
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_EQ(pieces[0].first, 0.0);
    EXPECT_NEAR(pieces[0].second, 0.0007, 1e-15);
    EXPECT_EQ(pieces[1].first, 1.7);
    EXPECT_NEAR(pieces[1].second, 0.0003, 1e-15);
}

TEST(DelayLine, AnyCommandsAndAnyDelay_AddUpToWhatWasGivenThen) {
    NoiseStream draw(17, "commands");
    for (const double delay_s : {0.0003, 0.001, 0.0037, 0.02, 0.4999}) {
        DelayLineState state = start_delay_line(delay_s, tick_s);
        std::vector<double> given;
        for (int k = 0; k < 3000; ++k) {
            given.push_back(draw.uniform());
            double area = 0.0, time_s = 0.0;
            for (const auto& [acting, duration_s] : pieces_of_tick(state, delay_s, given.back())) {
                area += acting * duration_s;
                time_s += duration_s;
            }
            EXPECT_NEAR(time_s, tick_s, 1e-15);
            // What acts in tick k was given in ticks k - whole - 1 (for the first `part`) and k - whole.
            const double ticks = delay_s / tick_s;
            const int whole = static_cast<int>(ticks + 1e-9);
            const double part = ticks - whole;
            const auto at = [&](int tick) { return tick < 0 ? 0.0 : given[static_cast<std::size_t>(tick)]; };
            EXPECT_NEAR(area, tick_s * (part * at(k - whole - 1) + (1.0 - part) * at(k - whole)), 1e-14);
        }
    }
}

}  // namespace
}  // namespace fidservo::plant
