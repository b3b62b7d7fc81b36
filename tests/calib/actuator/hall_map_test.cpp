// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/hall/hall_map.h"

#include "core/failure.h"
#include "core/result.h"
#include "core/rig.h"
#include "tests/calib/sweep.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

constexpr double exposure_s = 0.002;
constexpr int rest_ticks = 100;

/// Worst error of displacements over the travel, through the fitted map, mm.
double worst_error_mm(const MicroModel& model, const HallParameters& true_hall) {
    double worst = 0.0;
    for (double x = 0.2; x <= 3.8; x += 0.1) {
        const double adc = hall_voltage_V(true_hall, x) / hall_lsb_V(true_hall);
        worst = std::max(worst, std::abs(platform_position_mm(model, adc) - x));
    }
    return worst;
}

TEST(HallMap, SensorThatDiffersFromItsFile_IsRecoveredOverTheTravel) {
    for (const double gain : {0.95, 1.0, 1.02}) {
        for (const double delay_s : {0.0, 0.03}) {
            SCOPED_TRACE(::testing::Message() << "seed 7, gain " << gain << ", delay " << delay_s << " s");
            const Rig& rig = reference_rig();
            plant::PlantParameters physics = plant::plant_parameters(rig);
            physics.micro->hall.span_V *= gain;
            const Sweep sweep = make_sweep(physics, 7, delay_s);
            const auto map = fit_hall_map(rig.micro->hall, sweep.hall, sweep.sights, exposure_s, rest_ticks);
            ASSERT_TRUE(map) << map.error().text;
            EXPECT_NEAR(map->camera_delay_s, delay_s, 0.0008);
            MicroModel model = nominal_micro_model(*rig.micro);
            model.hall_correction = map->correction;
            EXPECT_LT(worst_error_mm(model, physics.micro->hall), 0.004);
            EXPECT_NEAR(map->correction[1], 1.0 / gain, 0.002);
        }
    }
}

TEST(HallMap, StandardErrorOfTheScale_IsTrue) {
    const Rig& rig = reference_rig();
    double squares = 0.0;
    constexpr int n = 40;
    for (int seed = 1; seed <= n; ++seed) {
        const Sweep sweep = make_sweep(plant::plant_parameters(rig), static_cast<std::uint64_t>(seed));
        const auto map = fit_hall_map(rig.micro->hall, sweep.hall, sweep.sights, exposure_s, rest_ticks);
        ASSERT_TRUE(map);
        squares += std::pow((map->correction[1] - 1.0) / map->scale_std, 2);
    }
    // 99.9 % of a chi-square law with 40 degrees of freedom, over 40.
    EXPECT_LT(squares / n, 1.84);
}

TEST(HallMap, PlatformThatHardlyMoves_IsRefused) {
    const Rig& rig = reference_rig();
    const Sweep sweep = make_sweep(plant::plant_parameters(rig), 3, 0.0, 0.2);
    const auto map = fit_hall_map(rig.micro->hall, sweep.hall, sweep.sights, exposure_s, rest_ticks);
    ASSERT_FALSE(map);
    EXPECT_EQ(map.error().reason, Reason::not_identifiable);
}

TEST(HallMap, TooFewFrames_AreRefused) {
    const Rig& rig = reference_rig();
    Sweep sweep = make_sweep(plant::plant_parameters(rig), 3);
    sweep.sights.resize(11);
    EXPECT_EQ(fit_hall_map(rig.micro->hall, sweep.hall, sweep.sights, exposure_s, rest_ticks).error().reason,
              Reason::not_identifiable);
}

}  // namespace
}  // namespace fidservo::calib
