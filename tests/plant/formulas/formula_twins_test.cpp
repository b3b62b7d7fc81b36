// SPDX-License-Identifier: GPL-3.0-or-later
// Effects of the catalogue written as formulas give the same rig.
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "src/simulation/practice_camera.h"
#include "tests/plant/formulas/texts.h"
#include "tests/plant/reference_rig.h"

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::plant {
namespace {

struct Twin {
    const char* listed;  ///< as for the option --effect
    const char* acts_on;
    const char* block;
    const char* formula;
    std::vector<Number> numbers;
    FormulaEffect::Memory memory = {};
};

void PrintTo(const Twin& twin, std::ostream* out) {
    *out << twin.listed << " = " << twin.formula;
}

/// What the stage does, and what the camera sees.
struct Course {
    std::vector<double> carriage_mm, speed_mm_per_s, camera_mm, hall_lsb, count;
    std::vector<double> seen;  ///< stamps in s, corners in px
};

Course course_of(const EffectSetting& setting) {
    PlantParameters parameters = plant_parameters(reference_rig());
    apply_effects(parameters, {&setting, 1});
    const StagePlant plant = make_stage_plant(parameters);
    StageState state = start(plant, 50.0, 17, EncoderOrigin::end_of_travel);
    PracticeCamera camera(reference_rig(), parameters, 5);
    std::vector<TagDetection> detections;
    Course course;
    for (int k = 0; k < 6000; ++k) {
        const double phase = 2.0 * std::numbers::pi * k / 1000.0;
        const double macro_V = k < 2000 ? 0.0 : 4.9 * std::sin(phase),
                     micro_V = 1.6 + 0.3 * std::sin(0.3 * phase);
        course.carriage_mm.push_back(state.axis.position_mm);
        course.speed_mm_per_s.push_back(state.axis.velocity_mm_per_s);
        course.camera_mm.push_back(camera_position_mm(state));
        course.hall_lsb.push_back(mean_reading_lsb(*plant.micro, *state.micro));
        course.count.push_back(mean_reading_count(plant.encoder, state.axis.position_mm));
        camera.look(state, k * ns_per_ms, macro_V, micro_V, detections);
        advance(plant, state, macro_V, micro_V);
    }
    for (const TagDetection& detection : detections) {
        course.seen.push_back(seconds(detection.time_ns));
        for (const Eigen::Vector2d& corner : detection.corners_px) {
            course.seen.push_back(corner.x());
            course.seen.push_back(corner.y());
        }
    }
    return course;
}

double worst(const std::vector<double>& left, const std::vector<double>& right) {
    if (left.size() != right.size()) return std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (std::size_t k = 0; k < left.size(); ++k) most = std::max(most, std::abs(left[k] - right[k]));
    return most;
}

class FormulaTwin : public testing::TestWithParam<Twin> {};

/// Both are integrated to the same tolerance, of 1e-8 mm a step, where there is no closed form.
TEST_P(FormulaTwin, MovesAndReadsAsTheListedEffect) {
    const Twin& twin = GetParam();
    FormulaEffect text = formula_text(twin.acts_on, twin.block, twin.formula, twin.numbers);
    if (!twin.memory.name.empty()) text.memories.push_back(twin.memory);
    const Course listed = course_of(parse_effect(twin.listed)),
                 own = course_of(typical_setting(effect_of(text)));
    const Course nominal = course_of(vanishing_setting(effect_of(text)));
    EXPECT_LT(worst(own.carriage_mm, listed.carriage_mm), 2e-6);
    EXPECT_LT(worst(own.speed_mm_per_s, listed.speed_mm_per_s), 2e-4);
    EXPECT_LT(worst(own.camera_mm, listed.camera_mm), 2e-6);
    EXPECT_LT(worst(own.hall_lsb, listed.hall_lsb), 2e-4);
    EXPECT_LT(worst(own.count, listed.count), 1e-4);
    EXPECT_LT(worst(own.seen, listed.seen), 1e-3);
    const bool changes = worst(listed.carriage_mm, nominal.carriage_mm) > 0.01 ||
                         worst(listed.hall_lsb, nominal.hall_lsb) > 0.3 ||
                         worst(listed.count, nominal.count) > 0.1 || worst(listed.seen, nominal.seen) > 1e-3;
    EXPECT_TRUE(changes) << "they are compared where they matter";
}

TEST_P(FormulaTwin, AtItsVanishingValues_LeavesTheRunAsItWasBitForBit) {
    const Twin& twin = GetParam();
    FormulaEffect text = formula_text(twin.acts_on, twin.block, twin.formula, twin.numbers);
    if (!twin.memory.name.empty()) text.memories.push_back(twin.memory);
    const Course without = course_of(vanishing_setting(*find_effect("cogging")));
    const Course vanished = course_of(vanishing_setting(effect_of(text)));
    EXPECT_EQ(vanished.carriage_mm, without.carriage_mm);
    EXPECT_EQ(vanished.camera_mm, without.camera_mm);
    EXPECT_EQ(vanished.hall_lsb, without.hall_lsb);
    EXPECT_EQ(vanished.seen, without.seen);
}

using Kind = FormulaEffect::Memory::Kind;

INSTANTIATE_TEST_SUITE_P(
    Catalogue, FormulaTwin,
    testing::Values(
        Twin{"drive_gain:factor=0.8",
             "macro.drive_voltage",
             "macro.drive",
             "more * command",
             {{"more", -0.2}}},
        Twin{"drive_offset:offset_V=0.2", "macro.force", "macro.drive", "push", {{"push", 0.2}}},
        Twin{"drive_delay:delay_ms=7",
             "macro.drive_voltage",
             "macro.drive",
             "on * (late - command)",
             {{"on", 1.0}},
             {"late", Kind::delay, "command", "0.007"}},
        Twin{"coulomb_friction:level_V=0.1,dead_zone_share=0",
             "macro.friction",
             "macro.friction",
             "level * direction",
             {{"level", 0.1}}},
        Twin{"stribeck_friction:level_V=0.2,speed_mm_per_s=12",
             "macro.friction",
             "macro.friction",
             "level * exp(-abs(speed) / falls) * sign(speed)",
             {{"level", 0.2}, {"falls", 12.0, "shape"}}},
        Twin{"viscous_friction:damping_V_s_per_mm=0.002",
             "macro.friction",
             "macro.friction",
             "c * speed",
             {{"c", 0.002}}},
        Twin{"cogging:amplitude_V=0.1,period_mm=5,phase_rad=0.4",
             "macro.force",
             "macro.mechanics",
             "amplitude * sin(2 * pi * place / period + 0.4)",
             {{"amplitude", 0.1}, {"period", 5.0, "shape"}}},
        Twin{"cable_force:stiffness_V_per_mm=0.003,centre_mm=80",
             "macro.force",
             "macro.mechanics",
             "-k * (place - centre)",
             {{"k", 0.003}, {"centre", 80.0, "shape"}}},
        Twin{"encoder_ripple:amplitude_um=30,period_mm=2,phase_rad=0.3",
             "macro.encoder",
             "macro.encoder",
             "amplitude * sin(2 * pi * place / 2 + 0.3)",
             {{"amplitude", 0.03}}},
        Twin{"heater_gain:factor=0.9",
             "micro.heater_power",
             "micro.heater",
             "more * heater_power",
             {{"more", -0.1}}},
        Twin{"stress_shift:shift_degC=5",
             "micro.transformation",
             "micro.hysteresis",
             "shift",
             {{"shift", 5.0}}},
        Twin{"stroke_change:factor=0.9",
             "micro.contraction",
             "micro.hysteresis",
             "more * contraction",
             {{"more", -0.1}}},
        Twin{"hall_offset:offset_V=0.03", "micro.hall_voltage", "micro.hall", "zero", {{"zero", 0.03}}},
        Twin{"hall_drift:rate_mV_per_s=2",
             "micro.hall_voltage",
             "micro.hall",
             "rate * time",
             {{"rate", 0.002}}},
        Twin{"pixel_scale:factor=1.01", "camera.scale", "camera.geometry", "more", {{"more", 0.01}}},
        Twin{"camera_rotation:angle_deg=2",
             "camera.rotation",
             "camera.geometry",
             "turn * pi / 180",
             {{"turn", 2.0}}},
        Twin{"camera_latency:delay_ms=6", "camera.frame_time", "camera.timing", "late", {{"late", 0.006}}}),
    [](const auto& instance) {
        const std::string listed = instance.param.listed;
        return listed.substr(0, listed.find(':'));
    });

}  // namespace
}  // namespace fidservo::plant
