// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/preisach.h"

#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

/// A table with a density that is easy to integrate: f(a, b) of the uniform density 1 mm / degC^2 on a > b.
/// f(a, b) = area of {b' < a' <= a, b' <= b} above the grid's lower end.
FodTable uniform_density_table() {
    std::vector<double> nodes, values;
    for (int i = 0; i <= 50; ++i) nodes.push_back(10.0 + 2.0 * i);
    for (int i = 0; i <= 50; ++i)
        for (int j = 0; j <= i; ++j) {
            const double a = nodes[static_cast<std::size_t>(i)] - 10.0,
                         b = nodes[static_cast<std::size_t>(j)] - 10.0;
            values.push_back(1e-3 * (0.5 * a * a - 0.5 * (a - b) * (a - b)));
        }
    return {nodes, values};
}

/// The double integral over relays on a grid: relay (up, down) switches on when heated to up, off when
/// cooled to down. Independent of the table's evaluation by memory of extrema.
class RelayGrid {
  public:
    explicit RelayGrid(double start_degC) : on_(cells * cells, false) { move(start_degC); }

    void move(double temp_degC) {
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j <= i; ++j) {
                const double up = centre(i), down = centre(j);
                if (temp_degC >= up) on_[index(i, j)] = true;
                if (temp_degC <= down) on_[index(i, j)] = false;
            }
    }

    double contraction_mm() const {
        double sum = 0.0;
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j <= i; ++j)
                if (on_[index(i, j)]) sum += (i == j ? 0.5 : 1.0) * 1e-3 * width * width;
        return sum;
    }

  private:
    static constexpr int cells = 200;
    static constexpr double width = 0.5;
    static double centre(int k) { return 10.0 + width * (k + 0.5); }
    static std::size_t index(int i, int j) {
        return static_cast<std::size_t>(i) * cells + static_cast<std::size_t>(j);
    }
    std::vector<bool> on_;
};

TEST(FodTable, OnNodesAndDiagonal_GivesTableValues) {
    const FodTable table = uniform_density_table();
    EXPECT_DOUBLE_EQ(table.contraction_mm(50.0, 50.0), 1e-3 * 800.0);
    EXPECT_DOUBLE_EQ(table.contraction_mm(50.0, 10.0), 0.0);
    EXPECT_DOUBLE_EQ(table.contraction_mm(300.0, 300.0), table.stroke_mm());
    EXPECT_DOUBLE_EQ(table.contraction_mm(50.0, 60.0), table.contraction_mm(50.0, 50.0));
}

TEST(FodTable, AcrossTheDiagonalCell_IsContinuous) {
    const FodTable table = uniform_density_table();
    constexpr double step = 1e-7;
    for (double a = 11.0; a < 100.0; a += 0.37) {
        EXPECT_NEAR(table.contraction_mm(a, a), table.contraction_mm(a, a - step), 1e-6);
        EXPECT_NEAR(table.contraction_mm(a, a), table.contraction_mm(a + step, a), 1e-6);
    }
}

TEST(Preisach, RandomExcitation_MatchesRelayIntegral) {
    const FodTable table = uniform_density_table();
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        NoiseStream noise(seed, "excitation");
        PreisachMemory memory = preisach_start(table, 22.0);
        RelayGrid relays(22.0);
        for (int k = 0; k < 200; ++k) {
            const double temp = 12.0 + 96.0 * noise.uniform();
            relays.move(temp);
            const double foreseen = preisach_peek(table, memory, temp);
            const double x = preisach_step(table, memory, temp);
            ASSERT_DOUBLE_EQ(foreseen, x);
            ASSERT_NEAR(x, relays.contraction_mm(), 0.1) << "step " << k << " to " << temp;
        }
    }
}

TEST(Preisach, SmallStepsAndOneMove_GiveTheSameState) {
    const FodTable table = uniform_density_table();
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        NoiseStream noise(seed, "excitation");
        PreisachMemory fine = preisach_start(table, 22.0), coarse = fine;
        for (int k = 0; k < 50; ++k) {
            const double from = coarse.temp_degC, to = 15.0 + 90.0 * noise.uniform();
            for (int i = 1; i <= 37; ++i)
                preisach_step(table, fine, i == 37 ? to : from + (to - from) * i / 37.0);
            preisach_step(table, coarse, to);
            ASSERT_NEAR(fine.contraction_mm, coarse.contraction_mm, 1e-12);
            ASSERT_EQ(fine.loops.size(), coarse.loops.size());
        }
    }
}

TEST(Preisach, ClosedMinorLoop_IsWipedOut) {
    const FodTable table = uniform_density_table();
    PreisachMemory memory = preisach_start(table, 22.0);
    preisach_step(table, memory, 80.0);
    preisach_step(table, memory, 50.0);
    const PreisachMemory before = memory;
    for (const double temp : {60.0, 55.0, 58.0, 50.0, 49.0}) preisach_step(table, memory, temp);
    PreisachMemory direct = before;
    preisach_step(table, direct, 49.0);
    EXPECT_DOUBLE_EQ(memory.contraction_mm, direct.contraction_mm);
    EXPECT_EQ(memory.loops.size(), direct.loops.size());
}

TEST(Preisach, TemperatureHeldWhileCooling_ChangesNothing) {
    const FodTable table = uniform_density_table();
    PreisachMemory memory = preisach_start(table, 22.0);
    preisach_step(table, memory, 80.0);
    preisach_step(table, memory, 60.0);
    PreisachMemory held = memory;
    preisach_step(table, held, 60.0);
    EXPECT_DOUBLE_EQ(preisach_step(table, held, 70.0), preisach_step(table, memory, 70.0));
}

TEST(Preisach, Inverse_ReturnsTheTemperatureThatWasApplied) {
    const FodTable table = uniform_density_table();
    NoiseStream noise(7, "excitation");
    PreisachMemory memory = preisach_start(table, 22.0);
    for (int k = 0; k < 200; ++k) {
        const double temp = 15.0 + 90.0 * noise.uniform();
        const auto inverse = preisach_inverse(table, memory, preisach_peek(table, memory, temp));
        ASSERT_TRUE(inverse);
        ASSERT_NEAR(*inverse, temp, 1e-6) << "step " << k;
        preisach_step(table, memory, temp);
    }
    EXPECT_FALSE(preisach_inverse(table, memory, 2.0 * table.stroke_mm()));
    EXPECT_FALSE(preisach_inverse(table, memory, -0.1));
}

TEST(Preisach, DecreasingCycles_MemoryGrowsAndOneLargeCycleClearsIt) {
    const FodTable table = uniform_density_table();
    PreisachMemory memory = preisach_start(table, 22.0);
    for (int k = 0; k < 20; ++k) {
        preisach_step(table, memory, 100.0 - k);
        preisach_step(table, memory, 40.0 + k);
    }
    EXPECT_EQ(memory.loops.size(), 19u);
    preisach_step(table, memory, 110.0);
    EXPECT_EQ(memory.loops.size(), 0u);
}

}  // namespace
}  // namespace fidservo
