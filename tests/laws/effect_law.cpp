// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/laws/effect_law.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>

namespace fidservo::plant {

void PrintTo(const Effect* effect, std::ostream* out) {
    *out << effect->name;
}

}  // namespace fidservo::plant

namespace fidservo::testing {
namespace {

using reference::Departures;

constexpr double rad_per_deg = std::numbers::pi / 180.0;

/// Factor on the rig file's damping that adds so many V s/mm to it.
double damping_factor(const Rig& rig, double added_V_s_per_mm) {
    return 1.0 + rig.macro.velocity_gain_mm_per_s_per_V * added_V_s_per_mm;
}

void belt(Departures& to, const Rig& /*rig*/) {
    to.mechanics.stretch =
        reference::Stretch{.compliance_mm_per_V = 0.4, .damping_ratio = 0.1, .motor_share = 0.4};
}

void bristles(Departures& to, const Rig& /*rig*/) {
    to.friction.coulomb_V = 0.1;
    to.friction.bristles = reference::Bristles{.stiffness_V_per_mm = 0.1 / 0.05, .damping_V_s_per_mm = 0.0};
}

/// Of a mass that takes 1.5 times what it gives back: the rest is lost to the room. Its conduction is so good
/// that it has one temperature.
void second_mass(Departures& to, const Rig& rig) {
    constexpr double conductance = 0.25, mass_tau_s = 20.0, taken = 1.5, well_conducting_s = 5e-3;
    const double conductance_per_s = conductance / rig.micro->heater.cooling_tau_s;
    to.heater.mount = {.conductance_per_s = conductance_per_s,
                       .capacity_ratio = conductance_per_s * mass_tau_s,
                       .diffusion_s = well_conducting_s,
                       .loss_s = mass_tau_s / (taken - 1.0)};
}

void spring_that_hardens(Departures& to, const Rig& /*rig*/) {
    to.mechanics.cable_V_per_mm = 0.002;
    to.mechanics.cable_centre_mm = 90.0;
    to.mechanics.cable_cubic_per_mm2 = 2.0 / std::pow(100.0, 2);
}

void tilt(Departures& to, const Rig& /*rig*/) {
    constexpr double about_u_rad = 0.5 * rad_per_deg, about_v_rad = -0.3 * rad_per_deg;
    to.camera.tilt_rad = -std::hypot(about_u_rad, about_v_rad);
    to.camera.tilt_axis_rad = std::atan2(about_v_rad, about_u_rad);
    to.camera.tilt_height = 0.4;
}

void two_dampings(Departures& to, const Rig& rig) {
    to.friction.viscous_forward = damping_factor(rig, 0.0004);
    to.friction.viscous_backward = damping_factor(rig, -0.0003);
}

constexpr std::array laws{
    EffectLaw{"drive_gain:factor=0.93", [](auto& to, const Rig&) { to.drive.gain = 0.93; }},
    EffectLaw{"drive_delay:delay_ms=2.4", [](auto& to, const Rig&) { to.drive.delay_s = 2.4e-3; }},
    EffectLaw{"drive_offset:offset_V=-0.08", [](auto& to, const Rig&) { to.drive.offset_V = -0.08; }},
    EffectLaw{"coulomb_friction:level_V=0.12,dead_zone_share=0.3",
              [](auto& to, const Rig&) {
                  to.friction.coulomb_V = 0.12;
                  to.friction.dead_zone_on_motion = 0.3;
              }},
    EffectLaw{"stribeck_friction:level_V=0.2,speed_mm_per_s=20",
              [](auto& to, const Rig&) {
                  to.friction.stribeck_V = 0.2;
                  to.friction.stribeck_speed_mm_per_s = 20.0;
                  to.friction.stribeck_exponent = 1.0;
              },
              "stribeck_friction:level_V=0.05,speed_mm_per_s=300"},
    EffectLaw{"viscous_friction:damping_V_s_per_mm=0.0005",
              [](auto& to, const Rig& rig) {
                  to.friction.viscous_forward = to.friction.viscous_backward = damping_factor(rig, 0.0005);
              }},
    EffectLaw{"friction_asymmetry:right_V_s_per_mm=0.0004,left_V_s_per_mm=-0.0003", two_dampings,
              "friction_asymmetry:right_V_s_per_mm=0.0004,left_V_s_per_mm=0.0004"},
    EffectLaw{"presliding:level_V=0.1,distance_um=50", bristles, "presliding:level_V=0.1,distance_um=0.1"},
    EffectLaw{"rail_patch:level_V=0.2,centre_mm=95,width_mm=10",
              [](auto& to, const Rig&) {
                  to.friction.patch_V = 0.2;
                  to.friction.patch_centre_mm = 95.0;
                  to.friction.patch_width_mm = 10.0;
              },
              "rail_patch:level_V=0.1,centre_mm=100,width_mm=200"},
    EffectLaw{"cogging:amplitude_V=0.1,period_mm=5,phase_rad=0.7,second_sine=0.2",
              [](auto& to, const Rig&) {
                  to.mechanics.cogging_V = 0.1;
                  to.mechanics.cogging_period_mm = 5.0;
                  to.mechanics.cogging_phase_rad = 0.7;
                  to.mechanics.cogging_second = 0.2;
                  to.mechanics.cogging_second_phase_rad = 2.0 * 0.7;
              }},
    EffectLaw{"cable_force:stiffness_V_per_mm=0.002,centre_mm=90,hardening=2", spring_that_hardens,
              "cable_force:stiffness_V_per_mm=0.0001,centre_mm=1000"},
    EffectLaw{"payload:mass_factor=1.3", [](auto& to, const Rig&) { to.mechanics.payload = 1.3; }},
    EffectLaw{"belt_compliance:stretch_um_per_V=400,damping_ratio=0.1,motor_share=0.4", belt},
    EffectLaw{"backlash:width_um=200", [](auto& to, const Rig&) { to.mechanics.play_mm = 0.2; }},
    EffectLaw{"encoder_scale:factor=1.01", [](auto& to, const Rig&) { to.encoder.scale = 1.0 / 1.01; }},
    EffectLaw{"encoder_ripple:amplitude_um=300,period_mm=5,phase_rad=0.7",
              [](auto& to, const Rig&) {
                  to.encoder.ripple_mm = 0.3;
                  to.encoder.ripple_period_mm = 5.0;
                  to.encoder.ripple_phase_rad = 0.7;
              }},
    EffectLaw{"ambient_temperature:shift_degC=-5",
              [](auto& to, const Rig&) { to.heater.ambient_degC = -5.0; }},
    EffectLaw{"airflow:factor=0.7", [](auto& to, const Rig&) { to.heater.cooling_tau = 0.7; }},
    EffectLaw{"heater_gain:factor=1.05", [](auto& to, const Rig&) { to.heater.gain = 1.05; }},
    EffectLaw{"heating_lag:factor=1.3", [](auto& to, const Rig&) { to.heater.heating_tau = 1.3; }},
    EffectLaw{"second_thermal_mass:conductance=0.25,mass_tau_s=20,taken=1.5", second_mass},
    EffectLaw{"heater_delay:delay_ms=20.3", [](auto& to, const Rig&) { to.heater.delay_s = 20.3e-3; }},
    EffectLaw{"stress_shift:shift_degC=-3,spring_degC_per_mm=1",
              [](auto& to, const Rig&) {
                  to.hysteresis.stress_shift_degC = -3.0;
                  to.hysteresis.stress_shift_degC_per_mm = 1.0;
              }},
    EffectLaw{"stroke_change:factor=1.05", [](auto& to, const Rig&) { to.hysteresis.stroke = 1.05; }},
    EffectLaw{"macro_coupling:gain=0.5,frequency_Hz=30,damping_ratio=0.05",
              [](auto& to, const Rig&) {
                  to.flexure = {.coupling = 0.5, .frequency_hz = 30.0, .damping_ratio = 0.05};
              }},
    EffectLaw{"hall_gain:factor=1.02", [](auto& to, const Rig&) { to.hall.gain = 1.02; }},
    EffectLaw{"hall_offset:offset_V=0.02", [](auto& to, const Rig&) { to.hall.offset_V = 0.02; }},
    EffectLaw{"hall_nonlinearity:cubic_shift=0.06", [](auto& to, const Rig&) { to.hall.cubic = 0.06; }},
    EffectLaw{"hall_drift:rate_mV_per_s=1,settling_per_s=0.1",
              [](auto& to, const Rig&) {
                  to.hall.drift_V_per_s = 1e-3;
                  to.hall.drift_settling_s = 10.0;
              }},
    EffectLaw{"hall_crosstalk:leak_mV_per_V=4,lag_ms=3",
              [](auto& to, const Rig&) {
                  to.hall.crosstalk_V_per_V = 4e-3;
                  to.hall.crosstalk_filter_s = 3e-3;
              }},
    EffectLaw{"pixel_scale:factor=1.01", [](auto& to, const Rig&) { to.camera.scale = 1.01; }},
    EffectLaw{"camera_rotation:angle_deg=1",
              [](auto& to, const Rig&) { to.camera.rotation_rad = rad_per_deg; }},
    EffectLaw{"camera_tilt:about_u_deg=0.5,about_v_deg=-0.3,axis_height=0.4", tilt},
    EffectLaw{"lens_distortion:k1=-0.3", [](auto& to, const Rig&) { to.camera.distortion = -0.3; }},
    EffectLaw{"camera_latency:delay_ms=30", [](auto& to, const Rig&) { to.camera.latency_s = 30e-3; }},
    EffectLaw{"clock_skew:skew_ppm=2000", [](auto& to, const Rig&) { to.camera.clock_skew = 2e-3; }},
    EffectLaw{"defocus:blur_px=1.2", [](auto& to, const Rig&) { to.image.defocus_px = 1.2; }},
    EffectLaw{"motion_blur:extra_exposure_ms=5",
              [](auto& to, const Rig&) { to.image.extra_exposure_s = 5e-3; }},
    EffectLaw{"rolling_shutter:readout_ms=8", [](auto& to, const Rig&) { to.image.readout_s = 8e-3; }},
    EffectLaw{"uneven_light:gradient_u=0.15,gradient_v=-0.1,vignetting=0",
              [](auto& to, const Rig&) {
                  to.image.light_u = 0.15;
                  to.image.light_v = -0.1;
              }},
    EffectLaw{"sensor_noise:read_noise_e=40,gain_spread=0.02",
              [](auto& to, const Rig&) {
                  to.image.read_noise_e = 40.0;
                  to.image.gain_spread = 0.02;
              }},
};

}  // namespace

std::span<const EffectLaw> effect_laws() {
    return laws;
}

plant::PlantParameters with(const plant::EffectSetting& setting) {
    plant::PlantParameters parameters = plant::plant_parameters(reference_rig());
    plant::apply_effects(parameters, {&setting, 1});
    return parameters;
}

const EffectLaw* law_of(const plant::Effect& effect) {
    const auto is_of_it = [&](const EffectLaw& law) {
        return law.setting.substr(0, law.setting.find(':')) == effect.name;
    };
    const auto found = std::ranges::find_if(laws, is_of_it);
    return found == laws.end() ? nullptr : &*found;
}

}  // namespace fidservo::testing
