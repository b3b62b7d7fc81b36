// SPDX-License-Identifier: GPL-3.0-or-later
// The program's experiments on the reference model: the loop and the controllers are those of the simulator.
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/simulation/simulate.h"
#include "src/simulation/simulate_reference.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

constexpr std::uint64_t seed = 4;

Rig rig() {
    return load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
}

Recording on_reference(std::string_view kind, const Departures& departures = {}, std::uint64_t noise = seed) {
    const std::string name(kind);
    return simulate_reference(rig(), departures, make_experiment(kind, rig(), seed, name), name, noise);
}

TEST(SimulateReference, SameSeed_GivesTheSameRecordingAndAnotherSeedDoesNot) {
    const Recording one = on_reference("micro-servo"), same = on_reference("micro-servo");
    const Recording other = on_reference("micro-servo", {}, seed + 1);
    std::size_t equal = 0, equal_to_other = 0;
    for (std::size_t k = 0; k < one.rows.size(); ++k) {
        equal += one.rows[k].hall_adc == same.rows[k].hall_adc &&
                 one.rows[k].micro_command_V == same.rows[k].micro_command_V;
        equal_to_other += one.rows[k].hall_adc == other.rows[k].hall_adc;
    }
    EXPECT_EQ(equal, one.rows.size());
    EXPECT_LT(equal_to_other, one.rows.size());
}

TEST(SimulateReference, MacroSquareOfTheNominalRig_IsCountForCountThatOfTheSimulator) {
    const Experiment experiment = make_experiment("macro-square", rig(), seed, "macro-square");
    const Recording reference = on_reference("macro-square");
    const Recording plant = simulate(rig(), {}, experiment, "macro-square", seed);
    ASSERT_EQ(reference.rows.size(), plant.rows.size());
    for (std::size_t k = 0; k < plant.rows.size(); ++k)
        ASSERT_EQ(reference.rows[k].encoder_count, plant.rows[k].encoder_count) << k;
}

TEST(SimulateReference, Frames_ShowTheTagsThatTheSimulatorShows) {
    const Experiment experiment = make_experiment("macro-sweep", rig(), seed, "macro-sweep");
    const Recording reference = on_reference("macro-sweep");
    const Recording plant = simulate(rig(), {}, experiment, "macro-sweep", seed);
    ASSERT_EQ(reference.detections.size(), plant.detections.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < plant.detections.size(); ++i) {
        ASSERT_EQ(reference.detections[i].time_ns, plant.detections[i].time_ns);
        ASSERT_EQ(reference.detections[i].tag_id, plant.detections[i].tag_id);
        for (std::size_t corner = 0; corner < 4; ++corner)
            squares += (reference.detections[i].corners_px[corner] - plant.detections[i].corners_px[corner])
                           .squaredNorm();
    }
    const double draws = 8.0 * static_cast<double>(plant.detections.size());
    const double noise_px = std::numbers::sqrt2 * rig().camera->corner_noise_px;  // of a difference
    EXPECT_NEAR(std::sqrt(squares / draws), noise_px, 4.0 * noise_px / std::sqrt(2.0 * draws));
}

TEST(SimulateReference, LateCameraOnAFastClock_ShiftsAndStretchesTheStamps) {
    Departures departures;
    departures.camera.latency_s = 2e-3;
    departures.camera.clock_skew = 1e-2;
    const Recording nominal = on_reference("macro-sweep");
    const Recording late = on_reference("macro-sweep", departures);
    ASSERT_FALSE(late.detections.empty());
    // the k-th frame is stamped by the camera's clock, and 1 % more frames fit into the same time
    EXPECT_EQ((late.detections.front().time_ns - nanoseconds(5.3e-3)) % nanoseconds(20e-3), 0);
    const double last_s = seconds(late.detections.back().time_ns);
    EXPECT_NEAR(last_s / seconds(nominal.detections.back().time_ns), 1.01, 0.01);
    EXPECT_GT(last_s, 12.0);
}

}  // namespace
}  // namespace fidservo::reference
