// SPDX-License-Identifier: GPL-3.0-or-later
// Two statements of one effect, as one: what the plant then does.
#include "plant/effects/together.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "tests/plant/effects/effect_rig.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

/// Sizes at a share of the way from nothing to the usual size; other parameters typical.
StatedEffect of_size(const Effect& effect, double share) {
    EffectSetting setting = typical_setting(effect);
    for (std::size_t k = 0; k < setting.values.size(); ++k) {
        const EffectParameter& parameter = effect.parameters[k];
        if (parameter.is_size())
            setting.values[k] = parameter.vanishing + share * (parameter.usual() - parameter.vanishing);
    }
    return stated(setting);
}

/// The rig's positions and readings after half a second of commands to both stages.
struct Motion {
    StageState state;
    StageReading reading;
};

Motion moved(const PlantParameters& parameters) {
    const StagePlant plant = make_stage_plant(parameters);
    Motion motion{start(plant, 60.0, 1), {}};
    for (int tick = 0; tick < 500; ++tick)
        advance(plant, motion.state, tick < 300 ? 4.5 : -3.8, tick < 350 ? 1.8 : 1.3);
    motion.reading = sample(plant, motion.state);
    return motion;
}

void expect_same_camera(const CameraDeviation& one, const CameraDeviation& other, const std::string& name) {
    constexpr double rounding = 1e-7;  // of factors stated in ppm, their product
    EXPECT_NEAR(one.pixel_scale, other.pixel_scale, rounding) << name;
    EXPECT_NEAR(one.rotation_rad, other.rotation_rad, rounding) << name;
    EXPECT_NEAR((one.tilt_rad - other.tilt_rad).norm(), 0.0, rounding) << name;
    EXPECT_NEAR(one.distortion, other.distortion, rounding) << name;
    EXPECT_NEAR(one.delay_s, other.delay_s, rounding) << name;
    EXPECT_NEAR(one.clock_rate, other.clock_rate, rounding) << name;
    EXPECT_NEAR(one.readout_s, other.readout_s, rounding) << name;
    EXPECT_NEAR(one.extra_exposure_s, other.extra_exposure_s, rounding) << name;
    EXPECT_NEAR(one.extra_blur_px, other.extra_blur_px, rounding) << name;
    EXPECT_NEAR(one.extra_read_noise_e, other.extra_read_noise_e, rounding) << name;
    EXPECT_NEAR(one.gain_spread, other.gain_spread, rounding) << name;
    EXPECT_NEAR((one.light_gradient - other.light_gradient).norm(), 0.0, rounding) << name;
    EXPECT_NEAR(one.vignetting, other.vignetting, rounding) << name;
}

TEST(Together, EachEffectOfTheCatalogue_ChangesThePlantAsItsTwoStatementsDo) {
    for (const Effect* effect : effect_catalogue()) {
        const std::string name(effect->name);
        StatedEffect first = of_size(*effect, 0.5), second = of_size(*effect, 0.3);
        if (name == "coulomb_friction")  // its share of the dead zone acts in two ways
            for (StatedEffect* of : {&first, &second}) of->parameters[1].value = 0.0;
        Rig twice = reference_rig(), once = twice;
        twice.effects = {first, second};
        once.effects = {together(first, second)};
        const PlantParameters of_twice = plant_parameters(twice), of_once = plant_parameters(once);
        const Motion by_twice = moved(of_twice), by_once = moved(of_once);
        EXPECT_NEAR(by_once.state.axis.position_mm, by_twice.state.axis.position_mm, 1e-9) << name;
        EXPECT_NEAR(by_once.state.micro->position_mm, by_twice.state.micro->position_mm, 1e-9) << name;
        EXPECT_EQ(by_once.reading.encoder_count, by_twice.reading.encoder_count) << name;
        EXPECT_EQ(by_once.reading.hall_adc, by_twice.reading.hall_adc) << name;
        expect_same_camera(*of_once.camera, *of_twice.camera, name);
    }
}

TEST(Together, ParametersThatAreNotGivenAgain_StayAsTheyWere) {
    const StatedEffect both = together({"cogging", {{"amplitude_V", 0.05}, {"period_mm", 7.0}}},
                                       {"cogging", {{"amplitude_V", 0.02}}});
    EXPECT_NEAR(both.parameters[0].value, 0.07, 1e-12);
    EXPECT_EQ(both.parameters[1].value, 7.0);
}

TEST(Together, BeyondTheBounds_IsRefusedByName) {
    try {
        (void)together({"hall_gain", {{"factor", 1.4}}}, {"hall_gain", {{"factor", 1.2}}});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("hall_gain: factor: 1.68"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace fidservo::plant
