// SPDX-License-Identifier: GPL-3.0-or-later
// Labels agree with the catalogue: the plant with an effect predicts, to the floor, a rig with the
// independent model's departure of that name.
#include "src/selfcheck/draw/listed_effects.h"

#include "core/rig.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"
#include "src/files/rig/rig_file.h"
#include "src/selfcheck/draw/campaign.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

using reference::Departures;

struct Pair {
    const char* effect;
    void (*depart)(Departures& rig);
    std::vector<double> values;  ///< of the effect's parameters
};

const std::vector<Pair>& pairs() {
    static const double damping = [] {
        return 1.0 / load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml").macro.velocity_gain_mm_per_s_per_V;
    }();
    static const std::vector<Pair> all{
        {"drive_gain", [](Departures& rig) { rig.drive.gain = 1.05; }, {1.05}},
        {"drive_delay", [](Departures& rig) { rig.drive.delay_s = 5.4e-3; }, {5.4}},
        {"drive_offset", [](Departures& rig) { rig.drive.offset_V = 0.2; }, {0.2}},
        {"coulomb_friction", [](Departures& rig) { rig.friction.coulomb_V = 0.1; }, {0.1, 0.0, 0.0, 0.0}},
        {"coulomb_friction",
         [](Departures& rig) { rig.friction.dead_zone_on_motion = 0.4; },
         {0.0, 0.4, 0.0, 0.0}},
        {"coulomb_friction",
         [](Departures& rig) {
             rig.friction.coulomb_V = 0.1;
             rig.friction.creep_mm_per_s = 0.5;
         },
         {0.1, 0.0, 0.5, 0.0}},
        {"stribeck_friction",
         [](Departures& rig) {
             rig.friction.stribeck_V = 0.3;
             rig.friction.stribeck_speed_mm_per_s = 12.0;
             rig.friction.stribeck_exponent = 1.0;
         },
         {0.3, 12.0, 0.0, 1.0}},
        {"stribeck_friction",
         [](Departures& rig) {
             rig.friction.stribeck_V = 0.3;
             rig.friction.stribeck_speed_mm_per_s = 12.0;
             rig.friction.stribeck_exponent = 1.0;
             rig.friction.creep_mm_per_s = 0.3;
         },
         {0.3, 12.0, 0.3, 1.0}},
        {"stribeck_friction",
         [](Departures& rig) {
             rig.friction.stribeck_V = 0.3;
             rig.friction.stribeck_speed_mm_per_s = 20.0;
             rig.friction.stribeck_exponent = 2.0;
             rig.friction.creep_mm_per_s = 0.5;
         },
         {0.3, 20.0, 0.5, 2.0}},
        {"viscous_friction",
         [](Departures& rig) { rig.friction.viscous_forward = rig.friction.viscous_backward = 1.2; },
         {0.2 * damping}},
        {"friction_asymmetry",
         [](Departures& rig) {
             rig.friction.viscous_forward = 1.2;
             rig.friction.viscous_backward = 0.9;
         },
         {0.2 * damping, -0.1 * damping}},
        {"presliding",
         [](Departures& rig) {
             rig.friction.coulomb_V = 0.09;
             rig.friction.bristles = reference::Bristles{0.9, 0.002};
         },
         {0.09, 100.0, 0.002, 0.0}},
        {"rail_patch",
         [](Departures& rig) {
             rig.friction.patch_V = 0.2;
             rig.friction.patch_centre_mm = 110.0;
             rig.friction.patch_width_mm = 8.0;
         },
         {0.2, 110.0, 8.0, 0.0, 2.0}},
        {"rail_patch",
         [](Departures& rig) {
             rig.friction.patch_V = 0.2;
             rig.friction.patch_centre_mm = 110.0;
             rig.friction.patch_width_mm = 8.0;
             rig.friction.creep_mm_per_s = 0.4;
         },
         {0.2, 110.0, 8.0, 0.4, 2.0}},
        {"cogging",
         [](Departures& rig) {
             rig.mechanics.cogging_V = 0.2;
             rig.mechanics.cogging_period_mm = 5.0;
             rig.mechanics.cogging_phase_rad = 1.0;
             rig.mechanics.cogging_second = 0.3;
             rig.mechanics.cogging_second_phase_rad = 2.5;
         },
         {0.2, 5.0, 1.0, 0.3 * std::cos(2.5 - 2.0 * 1.0), 0.3 * std::sin(2.5 - 2.0 * 1.0)}},
        {"cable_force", [](Departures& rig) { rig.mechanics.cable_V_per_mm = 0.004; }, {0.004, 100.0, 0.0}},
        {"cable_force",
         [](Departures& rig) {
             rig.mechanics.cable_V_per_mm = 0.002;
             rig.mechanics.cable_cubic_per_mm2 = 2e-4;
         },
         {0.002, 100.0, 2.0}},
        {"payload", [](Departures& rig) { rig.mechanics.payload = 1.3; }, {1.3}},
        {"belt_compliance",
         [](Departures& rig) {
             rig.mechanics.stretch = reference::Stretch{1.0, 0.05, 0.4};
         },
         {1000.0, 0.05, 0.4}},
        {"backlash", [](Departures& rig) { rig.mechanics.play_mm = 0.5; }, {500.0}},
        {"encoder_scale", [](Departures& rig) { rig.encoder.scale = 1.0 / 1.02; }, {1.02}},
        {"encoder_ripple",
         [](Departures& rig) {
             rig.encoder.ripple_mm = 0.1;
             rig.encoder.ripple_period_mm = 5.0;
         },
         {100.0, 5.0, 0.0}},
        {"ambient_temperature", [](Departures& rig) { rig.heater.ambient_degC = 5.0; }, {5.0}},
        {"airflow", [](Departures& rig) { rig.heater.cooling_tau = 0.8; }, {0.8}},
        {"heater_gain", [](Departures& rig) { rig.heater.gain = 1.05; }, {1.05}},
        {"heating_lag", [](Departures& rig) { rig.heater.heating_tau = 1.2; }, {1.2}},
        {"heater_delay", [](Departures& rig) { rig.heater.delay_s = 0.0504; }, {50.4}},
        {"stress_shift", [](Departures& rig) { rig.hysteresis.stress_shift_degC = 8.0; }, {8.0, 0.0}},
        {"stress_shift", [](Departures& rig) { rig.hysteresis.stress_shift_degC_per_mm = 2.0; }, {0.0, 2.0}},
        {"stroke_change", [](Departures& rig) { rig.hysteresis.stroke = 0.95; }, {0.95}},
        {"macro_coupling",
         [](Departures& rig) {
             rig.flexure = {1.0, 25.0, 0.05};
         },
         {1.0, 25.0, 0.05}},
        {"hall_gain", [](Departures& rig) { rig.hall.gain = 1.05; }, {1.05, 1.0}},
        {"hall_gain", [](Departures& rig) { rig.hall.supply = 1.05; }, {1.05, 0.0}},
        {"hall_offset", [](Departures& rig) { rig.hall.offset_V = 0.1; }, {0.1, 0.0}},
        {"hall_nonlinearity", [](Departures& rig) { rig.hall.cubic = 0.08; }, {0.08, 1.0}},
        {"hall_nonlinearity", [](Departures& rig) { rig.hall.cube = 0.04; }, {-0.04, 0.0}},
        {"hall_drift", [](Departures& rig) { rig.hall.drift_V_per_s = 2e-3; }, {2.0, 0.0}},
        {"hall_drift",
         [](Departures& rig) {
             rig.hall.drift_V_per_s = 4e-3;
             rig.hall.drift_settling_s = 8.0;
         },
         {4.0, 0.125}},
        {"hall_crosstalk", [](Departures& rig) { rig.hall.crosstalk_V_per_V = 0.01; }, {10.0, 0.0}},
        {"hall_crosstalk",
         [](Departures& rig) {
             rig.hall.crosstalk_V_per_V = 0.01;
             rig.hall.crosstalk_filter_s = 0.004;
         },
         {10.0, 4.0}},
        {"pixel_scale", [](Departures& rig) { rig.camera.scale = 1.02; }, {1.02}},
        {"camera_rotation",
         [](Departures& rig) { rig.camera.rotation_rad = std::numbers::pi / 180.0; },
         {1.0}},
        {"camera_tilt",
         [](Departures& rig) {
             rig.camera.tilt_rad = -std::numbers::pi / 180.0;
             rig.camera.tilt_axis_rad = std::numbers::pi / 2.0;
             rig.camera.tilt_height = 0.4;
         },
         {0.0, 1.0, 0.4}},
        {"lens_distortion", [](Departures& rig) { rig.camera.distortion = 0.5; }, {0.5}},
        {"camera_latency", [](Departures& rig) { rig.camera.latency_s = 0.05; }, {50.0}},
        {"clock_skew", [](Departures& rig) { rig.camera.clock_skew = 1e-3; }, {1000.0}},
    };
    return all;
}

/// For the excluded pair the independent model has another law: a rod in place of a lumped mass.
TEST(ListedEffects, Pairs_AreAllThatAreDrawnButOne) {
    std::set<std::string_view> drawn{"second_thermal_mass"}, paired = drawn;
    for (const EffectDraw& draw : listed_effects()) drawn.insert(draw.effect);
    for (const Pair& pair : pairs()) paired.insert(pair.effect);
    EXPECT_EQ(drawn, paired);
}

TEST(SlowListedEffects, DepartureOfTheReference_IsTheEffectOfThatName) {
    const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    constexpr std::array<std::string_view, 4> names{"macro-pulses-1", "macro-square-1", "micro-steps-1",
                                                    "integrated-1"};
    for (const Pair& pair : pairs()) {
        TrueRig true_rig{rig, {}};
        pair.depart(true_rig.departures);
        ASSERT_EQ(pair.values.size(), plant::find_effect(pair.effect)->parameters.size()) << pair.effect;
        std::vector<Recording> recordings;
        for (const CampaignRun& run : campaign_runs(rig))
            if (std::ranges::find(names, run.name) != names.end())
                recordings.push_back(record_run(rig, true_rig, run, 3));
        const gap::Evidence evidence(rig, std::move(recordings));
        const auto squares_of = [&](const gap::Hypothesis& hypothesis) {
            return gap::mean_squares(evidence.windows(),
                                     evidence.errors(hypothesis, gap::everything(evidence)));
        };
        const auto gaps = gap::signal_gaps(evidence, squares_of({}),
                                           squares_of({{plant::find_effect(pair.effect), pair.values}}));
        double before = 0.0;
        for (const gap::SignalGap& signal : gaps) {
            before = std::max(before, signal.before / signal.floor);
            EXPECT_LE(signal.after / signal.floor, 1.15) << pair.effect << ' ' << name_of(signal.signal);
        }
        std::printf("%-20s %.3g floors before\n", pair.effect, before);
        EXPECT_GE(before, 3.0) << pair.effect;
    }
}

}  // namespace
}  // namespace fidservo::selfcheck
