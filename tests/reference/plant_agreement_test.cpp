// SPDX-License-Identifier: GPL-3.0-or-later
// Two independent models of one machine, in closed form (plant/) and integrated (reference/), must give the
// same motion under the same commands. Each checks the other.
#include "core/random.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/stage_plant.h"
#include "reference/reference_rig.h"
#include "src/files/rig/rig_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

/// Commands of random length and height, held for 1 to 400 ticks, beyond the limits and within the dead zone.
class RandomCommand {
  public:
    RandomCommand(std::uint64_t seed, std::string_view name, double low_V, double high_V)
        : draw_(seed, name), low_V_(low_V), high_V_(high_V) {}

    double next() {
        if (left_-- > 0) return volts_;
        left_ = static_cast<int>(400.0 * draw_.uniform());
        volts_ = low_V_ + (high_V_ - low_V_) * draw_.uniform();
        return volts_;
    }

  private:
    NoiseStream draw_;
    double low_V_, high_V_;
    double volts_ = 0.0;
    int left_ = 0;
};

TEST(PlantAgreement, RandomCommands_MoveBothModelsAlike) {
    const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    const RigModel model = make_rig_model(rig);
    const plant::StagePlant stage = plant::make_stage_plant(rig);
    double worst_carriage_mm = 0.0, worst_platform_mm = 0.0, worst_degC = 0.0;
    constexpr int ticks = 20'000;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomCommand motor(seed, "motor", -6.0, 6.0), heater(seed, "heater", 1.0, 2.0);
        State state = start(model, 20.0 * static_cast<double>(seed) - 10.0, seed);
        plant::StageState other = plant::start(stage, state.carriage.position_mm, seed);
        for (int k = 0; k < ticks; ++k) {
            const double macro_V = motor.next(), micro_V = heater.next();
            advance(model, state, macro_V, micro_V);
            plant::advance(stage, other, macro_V, micro_V);
            const Truth here = truth(model, state);
            const auto apart = [](double& worst, double a, double b) {
                worst = std::max(worst, std::abs(a - b));
            };
            apart(worst_carriage_mm, here.carriage_mm, other.axis.position_mm);
            apart(worst_platform_mm, here.platform_mm, other.micro->position_mm);
            apart(worst_degC, here.wire_degC, other.micro->heater.temp_degC);
        }
    }
    std::printf("largest differences: carriage %.2e mm, wire %.2e degC, platform %.2e mm\n",
                worst_carriage_mm, worst_degC, worst_platform_mm);
    EXPECT_LE(worst_carriage_mm, 1e-6);
    EXPECT_LE(worst_degC, 1e-6);
    EXPECT_LE(worst_platform_mm, 1e-6);
}

TEST(PlantAgreement, DeadZoneThatActsOnTheMotion_BrakesBothCarriagesAlike) {
    const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    for (const double share : {0.3, 1.0}) {
        Departures departures;
        departures.friction.dead_zone_on_motion = share;
        const RigModel model = make_rig_model(rig, departures);
        const auto effect =
            plant::parse_effect("coulomb_friction:level_V=0,dead_zone_share=" + std::to_string(share));
        plant::PlantParameters parameters = plant::plant_parameters(rig);
        plant::apply_effects(parameters, {&effect, 1});
        const plant::StagePlant stage = plant::make_stage_plant(parameters);
        RandomCommand motor(7, "motor", -5.0, 5.0);
        State state = start(model, 90.0, 1);
        plant::StageState other = plant::start(stage, 90.0, 1);
        double worst_mm = 0.0, way_mm = 0.0;
        for (int k = 0; k < 20'000; ++k) {
            const double macro_V = motor.next();
            const double before_mm = other.axis.position_mm;
            advance(model, state, macro_V, 0.0);
            plant::advance(stage, other, macro_V, 0.0);
            way_mm += std::abs(other.axis.position_mm - before_mm);
            worst_mm = std::max(worst_mm, std::abs(state.carriage.position_mm - other.axis.position_mm));
        }
        EXPECT_GT(way_mm, 200.0);
        EXPECT_LE(worst_mm, 1e-4) << "share " << share;
    }
}

}  // namespace
}  // namespace fidservo::reference
