#include "plant/effects/catalogue.h"

#include "core/failure.h"
#include "tests/plant/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {

void PrintTo(const Effect* effect, std::ostream* out) {
    *out << effect->name;
}

namespace {

/// All that a run shows, and the truth behind it.
struct Row {
    std::int64_t encoder_count;
    int hall_adc;
    double carriage_mm, camera_mm, temp_degC, frame_delay_s;
    bool operator==(const Row&) const = default;
};

std::vector<Row> run(const StagePlant& plant) {
    StageState state = start(plant, 50.0, 17, EncoderOrigin::end_of_travel);
    std::vector<Row> rows;
    for (int k = 0; k < 8000; ++k) {
        const StageReading reading = sample(plant, state);
        rows.push_back({reading.encoder_count, reading.hall_adc, state.axis.position_mm,
                        camera_position_mm(state), state.micro->heater.temp_degC, plant.camera->delay_s});
        const double phase = 2.0 * std::numbers::pi * k / 1000.0;
        advance(plant, state, 4.9 * std::sin(phase), 1.6 + 0.3 * std::sin(0.3 * phase));
    }
    return rows;
}

class EachEffect : public testing::TestWithParam<const Effect*> {};

TEST_P(EachEffect, AtItsVanishingValues_LeavesTheRunAsItWasBitForBit) {
    const EffectSetting setting = vanishing_setting(*GetParam());
    EXPECT_EQ(run(make_stage_plant(reference_rig(), {&setting, 1})), run(make_stage_plant(reference_rig())));
}

TEST_P(EachEffect, AtItsTypicalValues_ChangesTheRun) {
    const EffectSetting setting = parse_effect(GetParam()->name);
    EXPECT_NE(run(make_stage_plant(reference_rig(), {&setting, 1})), run(make_stage_plant(reference_rig())));
}

TEST_P(EachEffect, AtItsBounds_GivesAFiniteRun) {
    for (std::size_t k = 0; k < GetParam()->parameters.size(); ++k)
        for (const double bound : {GetParam()->parameters[k].low, GetParam()->parameters[k].high}) {
            EffectSetting setting = vanishing_setting(*GetParam());
            setting.values[k] = bound;
            const Row last = run(make_stage_plant(reference_rig(), {&setting, 1})).back();
            EXPECT_TRUE(std::isfinite(last.camera_mm) && std::isfinite(last.temp_degC)) << bound;
        }
}

TEST_P(EachEffect, Description_IsCompleteAndConsistent) {
    const Effect& effect = *GetParam();
    static const std::set<std::string_view> blocks{"macro.drive",      "macro.friction",  "macro.mechanics",
                                                   "macro.encoder",    "micro.heater",    "micro.hall",
                                                   "micro.hysteresis", "micro.mechanics", "camera.geometry",
                                                   "camera.timing",    "camera.image"};
    EXPECT_TRUE(blocks.contains(effect.block)) << effect.block;
    EXPECT_FALSE(effect.text.empty());
    EXPECT_FALSE(effect.source.empty());
    EXPECT_EQ(find_effect(effect.name), &effect) << "names are unique";
    ASSERT_FALSE(effect.parameters.empty());
    for (const EffectParameter& parameter : effect.parameters) {
        EXPECT_LE(parameter.low, parameter.vanishing);
        EXPECT_LE(parameter.vanishing, parameter.high);
        EXPECT_LE(parameter.low, parameter.typical);
        EXPECT_LE(parameter.typical, parameter.high);
        EXPECT_FALSE(parameter.meaning.empty());
    }
    EXPECT_TRUE(std::ranges::any_of(effect.parameters, [](const EffectParameter& parameter) {
        return parameter.typical != parameter.vanishing;
    })) << "its strength; what only shapes it may have one value for both";
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EachEffect,
                         testing::ValuesIn(effect_catalogue().begin(), effect_catalogue().end()),
                         [](const auto& instance) { return std::string(instance.param->name); });

TEST(Effects, OrderOfSettings_DoesNotMatter) {
    std::vector<EffectSetting> forth, back;
    for (const Effect* effect : effect_catalogue()) forth.push_back(parse_effect(effect->name));
    back.assign(forth.rbegin(), forth.rend());
    const Row a = run(make_stage_plant(reference_rig(), forth)).back();
    const Row b = run(make_stage_plant(reference_rig(), back)).back();
    EXPECT_NEAR(a.camera_mm, b.camera_mm, 1e-9);
    EXPECT_NEAR(a.temp_degC, b.temp_degC, 1e-9);
}

TEST(Effects, OnAPartThatTheRigLacks_AreInputErrors) {
    for (const char* name : {"airflow", "hall_gain", "camera_latency"}) {
        const EffectSetting setting = parse_effect(name);
        EXPECT_THROW(make_stage_plant(macro_only_rig(), {&setting, 1}), InputError) << name;
    }
    const EffectSetting payload = parse_effect("payload");
    EXPECT_NO_THROW(make_stage_plant(macro_only_rig(), {&payload, 1}));
}

TEST(Effects, GivenTwice_AreInputErrors) {
    const std::vector<EffectSetting> twice{parse_effect("airflow"), parse_effect("airflow")};
    EXPECT_THROW(make_stage_plant(reference_rig(), twice), InputError);
}

}  // namespace
}  // namespace fidservo::plant
