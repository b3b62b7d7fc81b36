// SPDX-License-Identifier: GPL-3.0-or-later
// The wire along a recording, against the plant stepped tick by tick.
#include "gap/links/platform_link.h"

#include "core/rig.h"
#include "gap/links/wire_start.h"
#include "plant/effects/catalogue.h"
#include "tests/gap/effects.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

/// Without windows, so that no reading corrects the prediction: cold, heated, and cooling down.
PlatformRun uncorrected_run() {
    constexpr std::size_t cold_rows = 1500, heated_rows = 800, rows = 4000;
    PlatformRun run;
    run.tick_s = 1e-3;
    run.floor_lsb = 0.5;
    for (std::size_t k = 0; k < rows; ++k) {
        const bool is_heated = k >= cold_rows && k < cold_rows + heated_rows;
        run.command_V.push_back(is_heated ? 3.5 : 0.0);
        run.macro_command_V.push_back(k % 1000 < 500 ? 2.0 : 0.0);
        run.hall_adc.push_back(500.0);
        run.ticks.push_back(k == 700 ? 5 : 1);
    }
    return run;
}

class PredictedWire : public ::testing::TestWithParam<std::string_view> {};

TEST_P(PredictedWire, IsThatOfEveryTick_AlsoWhereItRests) {
    plant::PlantParameters parameters = plant::plant_parameters(reference_rig());
    plant::apply_effects(parameters, testing::effects({GetParam()}));
    const PlatformModel model = platform_model(parameters);
    const PlatformRun run = uncorrected_run();
    const PlatformPrediction found = predicted_readings(model, run, nullptr);
    plant::MicroStageState state = plant::start(model.stage, 0);
    std::size_t different = 0;
    for (std::size_t k = 0; k < run.command_V.size(); ++k) {
        if (found.path_lsb[k] != mean_reading_lsb(model.stage, state) ||
            found.temperature_degC[k] != state.heater.temp_degC)
            ++different;
        step(model, run, nullptr, k, state);
    }
    EXPECT_EQ(different, 0U);
}

INSTANTIATE_TEST_SUITE_P(Effects, PredictedWire,
                         ::testing::Values("airflow:factor=1", "airflow:factor=0.8", "ambient_temperature",
                                           "second_thermal_mass", "heater_delay", "hall_drift",
                                           "hall_crosstalk",
                                           "stress_shift:shift_degC=2,spring_degC_per_mm=1"));

/// On a rig with a tick of 5 ms, against the same wire stepped by milliseconds.
TEST(PredictedWireWithinTicks, IsThatOfAFinerTick) {
    Rig rig = reference_rig();
    rig.tick_s = 5e-3;
    const plant::PlantParameters parameters = plant::plant_parameters(rig);
    const FinerStage finer = finer_stage(parameters);
    ASSERT_EQ(finer.parts, 5U);
    PlatformRun run = uncorrected_run();
    run.tick_s = rig.tick_s;
    run.ticks.assign(run.ticks.size(), 1);
    const PlatformPrediction found = predicted_readings(platform_model(parameters), run, nullptr, &finer);
    plant::MicroStageState state = plant::start(finer.stage, 0);
    double worst_lsb = 0.0, most_bent_lsb = 0.0;
    for (std::size_t k = 0; k + 1 < run.command_V.size(); ++k)
        for (std::size_t part = 0; part < finer.parts; ++part) {
            const double share = static_cast<double>(part) / 5.0;
            const double bend_lsb = part == 0 ? 0.0 : found.bends_lsb[4 * k + part - 1];
            const double line_lsb = found.path_lsb[k] + share * (found.path_lsb[k + 1] - found.path_lsb[k]);
            worst_lsb =
                std::max(worst_lsb, std::abs(line_lsb + bend_lsb - mean_reading_lsb(finer.stage, state)));
            most_bent_lsb = std::max(most_bent_lsb, std::abs(bend_lsb));
            plant::advance(finer.stage, state, run.command_V[k], {});
        }
    EXPECT_LT(worst_lsb, 1e-6);
    EXPECT_GT(most_bent_lsb, 0.5) << "a straight line would do";
}

}  // namespace

}  // namespace fidservo
