// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/view/plate_view.h"
#include "src/files/rig/plate_file.h"
#include "src/simulation/practice_camera.h"
#include "tests/laws/effect_law.h"
#include "tests/plant/reference_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {

namespace {

/// What the stage shows at a tick, and the truth behind it.
struct Row {
    std::int64_t encoder_count;
    int hall_adc;
    double carriage_mm, camera_mm, temp_degC;
    bool operator==(const Row&) const = default;
};

std::vector<Row> run(const StagePlant& plant) {
    StageState state = start(plant, 50.0, 17, EncoderOrigin::end_of_travel);
    std::vector<Row> rows;
    for (int k = 0; k < 8000; ++k) {
        const StageReading reading = sample(plant, state);
        rows.push_back({reading.encoder_count, reading.hall_adc, state.axis.position_mm,
                        camera_position_mm(state), state.micro->heater.temp_degC});
        const double phase = 2.0 * std::numbers::pi * k / 1000.0;
        advance(plant, state, 4.9 * std::sin(phase), 1.6 + 0.3 * std::sin(0.3 * phase));
    }
    return rows;
}

/// What the camera shows: detections without images while the carriage sets off and stops again, and a
/// rendered frame in motion.
struct Seen {
    std::vector<TimeNs> stamps_ns;
    std::vector<std::array<Eigen::Vector2d, 4>> corners_px;
    std::vector<std::uint8_t> frame;
    bool operator==(const Seen&) const = default;
};

Seen see(const StagePlant& plant, const PlantParameters& parameters) {
    Seen seen;
    PracticeCamera camera(reference_rig(), parameters, 5);
    StageState state = start(plant, 50.0, 17, EncoderOrigin::end_of_travel);
    std::vector<TagDetection> detections;
    for (int k = 0; k < 600; ++k) {
        const double macro_V = k > 300 && k < 340 ? 3.5 : 0.0;
        camera.look(state, k * ns_per_ms, macro_V, 1.55, detections);
        advance(plant, state, macro_V, 1.55);
    }
    for (const TagDetection& detection : detections) {
        seen.stamps_ns.push_back(detection.time_ns);
        seen.corners_px.push_back(detection.corners_px);
    }
    CameraParameters small = reference_rig().camera.value();
    small.geometry.width_px = 320;
    small.geometry.height_px = 240;
    small.geometry.principal_point_px = {159.5, 119.5};
    const PlateView view(small, plate_of(reference_rig().fiducials.value()), {}, *parameters.camera);
    const cv::Mat frame = view.expose([](double after_s) { return 50.3 + 12.0 * after_s; }, 3);
    seen.frame.assign(frame.datastart, frame.dataend);
    return seen;
}

using fidservo::testing::with;

class EachEffect : public ::testing::TestWithParam<const Effect*> {};

TEST_P(EachEffect, AtItsVanishingValues_LeavesTheRunAsItWasBitForBit) {
    const PlantParameters nominal = plant_parameters(reference_rig());
    const PlantParameters vanished = with(vanishing_setting(*GetParam()));
    const StagePlant before = make_stage_plant(nominal), after = make_stage_plant(vanished);
    EXPECT_EQ(run(after), run(before));
    EXPECT_EQ(see(after, vanished), see(before, nominal));
}

TEST_P(EachEffect, AtItsTypicalValues_ChangesTheRun) {
    const PlantParameters nominal = plant_parameters(reference_rig());
    const PlantParameters changed = with(parse_effect(GetParam()->name));
    const StagePlant before = make_stage_plant(nominal), after = make_stage_plant(changed);
    if (GetParam()->block.starts_with("camera."))
        EXPECT_NE(see(after, changed), see(before, nominal));
    else
        EXPECT_NE(run(after), run(before));
}

TEST_P(EachEffect, AtItsBounds_GivesAFiniteRun) {
    for (std::size_t k = 0; k < GetParam()->parameters.size(); ++k)
        for (const double bound : {GetParam()->parameters[k].low, GetParam()->parameters[k].high}) {
            EffectSetting setting = vanishing_setting(*GetParam());
            setting.values[k] = bound;
            const Row last = run(make_stage_plant(reference_rig(), {&setting, 1})).back();
            EXPECT_TRUE(std::isfinite(last.camera_mm) && std::isfinite(last.temp_degC)) << bound;
            if (!GetParam()->block.starts_with("camera.")) continue;
            const PlantParameters parameters = with(setting);
            const Seen seen = see(make_stage_plant(parameters), parameters);
            for (const auto& corners : seen.corners_px)
                for (const Eigen::Vector2d& corner : corners) EXPECT_TRUE(corner.allFinite()) << bound;
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
                         ::testing::ValuesIn(effect_catalogue().begin(), effect_catalogue().end()),
                         ::testing::PrintToStringParamName());

TEST(Effects, OrderOfSettings_DoesNotMatter) {
    std::vector<EffectSetting> forth, back;
    for (const Effect* effect : effect_catalogue()) forth.push_back(parse_effect(effect->name));
    back.assign(forth.rbegin(), forth.rend());
    const Row a = run(make_stage_plant(reference_rig(), forth)).back();
    const Row b = run(make_stage_plant(reference_rig(), back)).back();
    EXPECT_NEAR(a.camera_mm, b.camera_mm, 1e-9);
    EXPECT_NEAR(a.temp_degC, b.temp_degC, 1e-9);
    PlantParameters first = plant_parameters(reference_rig()), second = first;
    apply_effects(first, forth);
    apply_effects(second, back);
    const Seen c = see(make_stage_plant(first), first), d = see(make_stage_plant(second), second);
    EXPECT_EQ(c.stamps_ns, d.stamps_ns);
    ASSERT_EQ(c.corners_px.size(), d.corners_px.size());
    for (std::size_t k = 0; k < c.corners_px.size(); ++k)
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_NEAR((c.corners_px[k][i] - d.corners_px[k][i]).norm(), 0.0, 1e-9);
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
