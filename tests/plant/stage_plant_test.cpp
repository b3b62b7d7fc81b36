// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/stage_plant.h"

#include "tests/plant/reference_rig.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

constexpr std::uint64_t seed = 42;

double macro_V(int k) {
    return 4.5 * std::sin(2.0 * std::numbers::pi * k / 700.0);
}
double micro_V(int k) {
    return 1.6 + 0.3 * std::sin(2.0 * std::numbers::pi * k / 3100.0);
}

struct Row {
    std::int64_t encoder_count;
    int hall_adc;
    double camera_mm;
    bool operator==(const Row&) const = default;
};

std::vector<Row> run(const StagePlant& plant, StageState& state, int from, int to) {
    std::vector<Row> rows;
    for (int k = from; k < to; ++k) {
        const StageReading reading = sample(plant, state);
        rows.push_back({reading.encoder_count, reading.hall_adc, camera_position_mm(state)});
        advance(plant, state, macro_V(k), micro_V(k));
    }
    return rows;
}

TEST(StagePlant, SameSeed_GivesTheSameRun) {
    const StagePlant plant = make_stage_plant(reference_rig());
    StageState first = start(plant, 100.0, seed), second = start(plant, 100.0, seed),
               other = start(plant, 100.0, seed + 1);
    const auto rows = run(plant, first, 0, 5000);
    EXPECT_EQ(rows, run(plant, second, 0, 5000));
    EXPECT_NE(rows, run(plant, other, 0, 5000));
}

TEST(StagePlant, Snapshot_ContinuesAsTheOriginal) {
    const StagePlant plant = make_stage_plant(reference_rig());
    StageState state = start(plant, 100.0, seed);
    run(plant, state, 0, 3000);
    StageState snapshot = state;
    const auto rows = run(plant, state, 3000, 9000);
    EXPECT_EQ(rows, run(plant, snapshot, 3000, 9000));
}

TEST(StagePlant, NoiseSoughtBack_RepeatsTheReading) {
    const StagePlant plant = make_stage_plant(reference_rig());
    StageState state = start(plant, 100.0, seed);
    run(plant, state, 0, 100);
    const std::uint64_t position = state.micro->hall_noise.position();
    std::vector<int> readings, again;
    for (int k = 0; k < 50; ++k) readings.push_back(sample(plant, state).hall_adc);
    state.micro->hall_noise.seek(position);
    for (int k = 0; k < 50; ++k) again.push_back(sample(plant, state).hall_adc);
    EXPECT_EQ(readings, again);
}

TEST(StagePlant, CameraPosition_IsMacroPlusMicro) {
    const StagePlant plant = make_stage_plant(reference_rig());
    StageState state = start(plant, 100.0, seed);
    run(plant, state, 0, 2000);
    EXPECT_EQ(camera_position_mm(state), state.axis.position_mm + state.micro->position_mm);
    EXPECT_GT(state.micro->position_mm, 1.0);
}

TEST(StagePlant, RigWithoutMicroStage_MovesItsCarriageAlike) {
    const StagePlant plant = make_stage_plant(reference_rig());
    const StagePlant bare = make_stage_plant(macro_only_rig());
    StageState state = start(plant, 100.0, seed), bare_state = start(bare, 100.0, seed);
    EXPECT_FALSE(bare_state.micro);
    EXPECT_FALSE(bare.camera);
    for (int k = 0; k < 2000; ++k) {
        const StageReading reading = sample(bare, bare_state);
        ASSERT_EQ(reading.encoder_count, sample(plant, state).encoder_count);
        ASSERT_EQ(reading.hall_adc, 0);
        advance(plant, state, macro_V(k), micro_V(k));
        advance(bare, bare_state, macro_V(k), 0.0);
    }
    EXPECT_EQ(camera_position_mm(bare_state), state.axis.position_mm);
}

}  // namespace
}  // namespace fidservo::plant
