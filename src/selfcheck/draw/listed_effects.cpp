// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/listed_effects.h"

#include "core/rig.h"
#include "gap/candidates/candidate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace fidservo::selfcheck {
namespace {

using reference::Departures;

double between(NoiseStream& draw, double low, double high) {
    return low + (high - low) * draw.uniform();
}

double phase_rad(NoiseStream& draw) {
    return between(draw, -std::numbers::pi, std::numbers::pi);
}

void drive_gain(Departures& rig, double size, NoiseStream& draw) {
    rig.drive.gain = random_factor(draw, size);
}
void drive_delay(Departures& rig, double size_s, NoiseStream& /*draw*/) {
    rig.drive.delay_s = size_s;
}
void drive_offset(Departures& rig, double size_V, NoiseStream& draw) {
    rig.drive.offset_V = random_sign(draw) * size_V;
}

void coulomb_friction(Departures& rig, double size_V, NoiseStream& /*draw*/) {
    rig.friction.coulomb_V += size_V;
}
/// What the file's dead zone holds acts on the motion instead: the same while driven, a brake while coasting.
void coulomb_dead_zone(Departures& rig, double size, NoiseStream& /*draw*/) {
    rig.friction.dead_zone_on_motion = size;
}
void stribeck_friction(Departures& rig, double size_V, NoiseStream& draw) {
    rig.friction.stribeck_V = size_V;
    rig.friction.stribeck_speed_mm_per_s = log_uniform(draw, 6.0, 40.0);
    rig.friction.stribeck_exponent = 1.0;
}
void stribeck_bell(Departures& rig, double size_V, NoiseStream& draw) {
    stribeck_friction(rig, size_V, draw);
    rig.friction.stribeck_exponent = 2.0;
}
/// Bristles so stiff that their bending is below a hundredth of a count.
void stribeck_bristles(Departures& rig, double size_V, NoiseStream& draw) {
    stribeck_friction(rig, size_V, draw);
    rig.friction.bristles = reference::Bristles{.stiffness_V_per_mm = 2000.0, .damping_V_s_per_mm = 0.1};
}
/// Lubricated: it lets the carriage creep at rest.
template <EffectDraw::Put dry>
void creeping(Departures& rig, double size_V, NoiseStream& draw) {
    dry(rig, size_V, draw);
    rig.friction.creep_mm_per_s = log_uniform(draw, 0.2, 1.0);
}
void viscous_friction(Departures& rig, double size, NoiseStream& /*draw*/) {
    rig.friction.viscous_forward *= 1.0 + size;
    rig.friction.viscous_backward *= 1.0 + size;
}
void friction_asymmetry(Departures& rig, double size, NoiseStream& draw) {
    const double forward = random_sign(draw) * size;
    rig.friction.viscous_forward *= 1.0 + forward;
    rig.friction.viscous_backward *= 1.0 - forward;
}
void presliding(Departures& rig, double size_V, NoiseStream& draw) {
    const double distance_mm = log_uniform(draw, 0.05, 0.5);
    rig.friction.coulomb_V += size_V;
    rig.friction.bristles =
        reference::Bristles{.stiffness_V_per_mm = size_V / distance_mm, .damping_V_s_per_mm = 0.0};
}
void rail_patch(Departures& rig, double size_V, NoiseStream& draw) {
    rig.friction.patch_V = size_V;
    rig.friction.patch_centre_mm = between(draw, 70.0, 130.0);
    rig.friction.patch_width_mm = log_uniform(draw, 4.0, 15.0);
}

void cogging(Departures& rig, double size_V, NoiseStream& draw) {
    rig.mechanics.cogging_V = size_V;
    rig.mechanics.cogging_period_mm = log_uniform(draw, 2.0, 20.0);
    rig.mechanics.cogging_phase_rad = phase_rad(draw);
    if (random_sign(draw) > 0.0) return;
    rig.mechanics.cogging_second = log_uniform(draw, 0.05, 0.3);
    rig.mechanics.cogging_second_phase_rad = phase_rad(draw);
}
void cable_force(Departures& rig, double size_V_per_mm, NoiseStream& draw) {
    rig.mechanics.cable_V_per_mm = size_V_per_mm;
    rig.mechanics.cable_centre_mm = between(draw, 60.0, 140.0);
}
void payload(Departures& rig, double size, NoiseStream& draw) {
    rig.mechanics.payload = random_factor(draw, size);
}
void hardening_cable(Departures& rig, double size_V_per_mm, NoiseStream& draw) {
    cable_force(rig, size_V_per_mm, draw);
    rig.mechanics.cable_cubic_per_mm2 = log_uniform(draw, 5e-5, 5e-4);
}
void belt_compliance(Departures& rig, double size_mm_per_V, NoiseStream& draw) {
    rig.mechanics.stretch = reference::Stretch{.compliance_mm_per_V = size_mm_per_V,
                                               .damping_ratio = log_uniform(draw, 0.02, 0.2),
                                               .motor_share = between(draw, 0.3, 0.7)};
}
void backlash(Departures& rig, double size_mm, NoiseStream& /*draw*/) {
    rig.mechanics.play_mm = size_mm;
}

void encoder_scale(Departures& rig, double size, NoiseStream& draw) {
    rig.encoder.scale = random_factor(draw, size);
}
void encoder_ripple(Departures& rig, double size_mm, NoiseStream& draw) {
    rig.encoder.ripple_mm = size_mm;
    rig.encoder.ripple_period_mm = log_uniform(draw, 2.0, 20.0);
    rig.encoder.ripple_phase_rad = phase_rad(draw);
}

void ambient_temperature(Departures& rig, double size_degC, NoiseStream& draw) {
    rig.heater.ambient_degC = random_sign(draw) * size_degC;
}
void airflow(Departures& rig, double size, NoiseStream& draw) {
    rig.heater.cooling_tau = random_factor(draw, size);
}
void heater_gain(Departures& rig, double size, NoiseStream& draw) {
    rig.heater.gain = random_factor(draw, size);
}
void heating_lag(Departures& rig, double size, NoiseStream& draw) {
    rig.heater.heating_tau = random_factor(draw, size);
}
void second_thermal_mass(Departures& rig, double size_per_s, NoiseStream& draw) {
    rig.heater.mount = {.conductance_per_s = size_per_s,
                        .capacity_ratio = log_uniform(draw, 2.0, 8.0),
                        .diffusion_s = log_uniform(draw, 0.5, 4.0),
                        .loss_s = log_uniform(draw, 20.0, 80.0)};
}
void heater_delay(Departures& rig, double size_s, NoiseStream& /*draw*/) {
    rig.heater.delay_s = size_s;
}

void stress_shift(Departures& rig, double size_degC, NoiseStream& draw) {
    rig.hysteresis.stress_shift_degC = random_sign(draw) * size_degC;
}
void stroke_change(Departures& rig, double size, NoiseStream& draw) {
    rig.hysteresis.stroke = random_factor(draw, size);
}
void macro_coupling(Departures& rig, double size, NoiseStream& draw) {
    rig.flexure = {.coupling = size,
                   .frequency_hz = log_uniform(draw, 12.0, 60.0),
                   .damping_ratio = log_uniform(draw, 0.02, 0.1)};
}

void hall_gain(Departures& rig, double size, NoiseStream& draw) {
    rig.hall.gain = random_factor(draw, size);
}
/// Of a ratiometric sensor.
void hall_supply(Departures& rig, double size, NoiseStream& draw) {
    rig.hall.supply = random_factor(draw, size);
}
void hall_offset(Departures& rig, double size_V, NoiseStream& draw) {
    rig.hall.offset_V = random_sign(draw) * size_V;
}
void hall_nonlinearity(Departures& rig, double size, NoiseStream& draw) {
    rig.hall.cubic = random_sign(draw) * size;
}
void hall_cube(Departures& rig, double size, NoiseStream& draw) {
    rig.hall.cube = random_sign(draw) * size;
}
void hall_drift(Departures& rig, double size_V_per_s, NoiseStream& draw) {
    rig.hall.drift_V_per_s = random_sign(draw) * size_V_per_s;
}
void hall_warm_up(Departures& rig, double size_V_per_s, NoiseStream& draw) {
    hall_drift(rig, size_V_per_s, draw);
    rig.hall.drift_settling_s = log_uniform(draw, 5.0, 20.0);
}
void hall_crosstalk(Departures& rig, double size_V_per_V, NoiseStream& draw) {
    rig.hall.crosstalk_V_per_V = random_sign(draw) * size_V_per_V;
    if (random_sign(draw) > 0.0) return;
    rig.hall.crosstalk_filter_s = log_uniform(draw, 1e-3, 8e-3);
}

void pixel_scale(Departures& rig, double size, NoiseStream& draw) {
    rig.camera.scale = random_factor(draw, size);
}
void camera_rotation(Departures& rig, double size_rad, NoiseStream& draw) {
    rig.camera.rotation_rad = random_sign(draw) * size_rad;
}
void camera_tilt(Departures& rig, double size_rad, NoiseStream& draw) {
    rig.camera.tilt_rad = random_sign(draw) * size_rad;
    rig.camera.tilt_axis_rad = phase_rad(draw);
    // A third each about the plate, about the camera, and between.
    rig.camera.tilt_height = std::clamp(between(draw, -1.0, 2.0), 0.0, 1.0);
}
void lens_distortion(Departures& rig, double size, NoiseStream& draw) {
    rig.camera.distortion = random_sign(draw) * size;
}
void camera_latency(Departures& rig, double size_s, NoiseStream& /*draw*/) {
    rig.camera.latency_s = size_s;
}
void clock_skew(Departures& rig, double size, NoiseStream& draw) {
    rig.camera.clock_skew = random_sign(draw) * size;
}

constexpr double rad_per_deg = std::numbers::pi / 180.0;

constexpr std::array draws{
    EffectDraw{"drive_gain", "", 2.7e-4, 0.3, drive_gain},
    EffectDraw{"drive_delay", "", 1.9e-4, 0.03, drive_delay},
    EffectDraw{"drive_offset", "", 1.1e-5, 0.6, drive_offset},
    EffectDraw{"coulomb_friction", "", 6.2e-4, 0.3, coulomb_friction},
    EffectDraw{"coulomb_friction", "dead zone", 4e-3, 1.0, coulomb_dead_zone},
    EffectDraw{"stribeck_friction", "", 5.3e-3, 0.4, stribeck_friction},
    EffectDraw{"stribeck_friction", "bell", 6.9e-3, 0.4, stribeck_bell},
    EffectDraw{"stribeck_friction", "LuGre", 6.2e-3, 0.4, stribeck_bristles},
    EffectDraw{"coulomb_friction", "creep", 6.2e-4, 0.3, creeping<coulomb_friction>},
    EffectDraw{"stribeck_friction", "creep", 5.3e-3, 0.4, creeping<stribeck_friction>},
    EffectDraw{"rail_patch", "creep", 4e-3, 0.6, creeping<rail_patch>},
    EffectDraw{"viscous_friction", "", 7.6e-4, 0.6, viscous_friction},
    EffectDraw{"friction_asymmetry", "", 6.7e-4, 0.4, friction_asymmetry},
    EffectDraw{"presliding", "LuGre", 5.1e-4, 0.3, presliding},
    EffectDraw{"rail_patch", "", 4e-3, 0.6, rail_patch},
    EffectDraw{"cogging", "", 5.5e-5, 0.5, cogging},
    EffectDraw{"cable_force", "", 6e-7, 0.01, cable_force},
    EffectDraw{"cable_force", "hardening", 5e-7, 0.005, hardening_cable},
    EffectDraw{"payload", "", 5.8e-3, 1.0, payload},
    EffectDraw{"belt_compliance", "", 2.6e-1, 2.0, belt_compliance},
    EffectDraw{"backlash", "", 4.4e-2, 1.0, backlash},
    EffectDraw{"encoder_scale", "", 5.3e-6, 0.05, encoder_scale},
    EffectDraw{"encoder_ripple", "", 4.3e-3, 0.3, encoder_ripple},
    EffectDraw{"ambient_temperature", "", 6.4e-3, 12.0, ambient_temperature},
    EffectDraw{"airflow", "", 7.9e-4, 0.8, airflow},
    EffectDraw{"heater_gain", "", 1.3e-4, 0.2, heater_gain},
    EffectDraw{"heating_lag", "", 6.7e-4, 0.8, heating_lag},
    EffectDraw{"second_thermal_mass", "rod", 2e-4, 0.4, second_thermal_mass},
    EffectDraw{"heater_delay", "", 4.6e-4, 0.15, heater_delay},
    EffectDraw{"stress_shift", "", 6.4e-3, 15.0, stress_shift},
    EffectDraw{"stroke_change", "", 5.7e-4, 0.15, stroke_change},
    EffectDraw{"macro_coupling", "", 1.3e-1, 2.0, macro_coupling},
    EffectDraw{"hall_gain", "", 5.5e-4, 0.2, hall_gain},
    EffectDraw{"hall_gain", "supply", 2.4e-4, 0.1, hall_supply},
    EffectDraw{"hall_offset", "", 6.6e-6, 0.3, hall_offset},
    EffectDraw{"hall_nonlinearity", "", 1.9e-3, 0.2, hall_nonlinearity},
    EffectDraw{"hall_nonlinearity", "cube", 6.5e-4, 0.1, hall_cube},
    EffectDraw{"hall_drift", "", 3.5e-5, 5e-3, hall_drift},
    EffectDraw{"hall_drift", "settling", 9e-5, 5e-3, hall_warm_up},
    EffectDraw{"hall_crosstalk", "", 5.2e-4, 0.02, hall_crosstalk},
    EffectDraw{"pixel_scale", "", 1.3e-4, 0.1, pixel_scale},
    EffectDraw{"camera_rotation", "", 1.2e-4, 5.0 * rad_per_deg, camera_rotation},
    EffectDraw{"camera_tilt", "", 2.9e-3, 2.0 * rad_per_deg, camera_tilt},
    EffectDraw{"lens_distortion", "", 3.4e-2, 1.5, lens_distortion},
    EffectDraw{"camera_latency", "", 3e-4, 0.15, camera_latency},
    EffectDraw{"clock_skew", "", 1.6e-5, 3e-3, clock_skew},
};

}  // namespace

std::span<const EffectDraw> listed_effects() {
    return draws;
}

const std::vector<std::string_view>& listed_classes() {
    static const std::vector<std::string_view> classes = [] {
        std::vector<std::string_view> found;
        for (const EffectDraw& draw : draws) {
            const std::string_view name = gap::class_of(draw.effect);
            if (std::ranges::find(found, name) == found.end()) found.push_back(name);
        }
        return found;
    }();
    return classes;
}

std::vector<const EffectDraw*> draws_of(std::string_view class_name) {
    return draws_of(class_name, draws);
}

std::vector<const EffectDraw*> draws_of(std::string_view class_name, std::span<const EffectDraw> ways) {
    std::vector<const EffectDraw*> found;
    for (const EffectDraw& way : ways)
        if (gap::class_of(way.effect) == class_name) found.push_back(&way);
    return found;
}

bool can_be_together(std::string_view class_name, std::string_view other) {
    using Pair = std::pair<std::string_view, std::string_view>;
    constexpr std::array parts{Pair{"viscous_friction", "friction_asymmetry"},
                               Pair{"coulomb_friction", "presliding"},
                               Pair{"stribeck_friction", "presliding"}, Pair{"backlash", "macro_coupling"}};
    return class_name != other && std::ranges::none_of(parts, [&](const Pair& pair) {
               return pair == Pair{class_name, other} || pair == Pair{other, class_name};
           });
}

double log_uniform(NoiseStream& draw, double low, double high) {
    return low * std::pow(high / low, draw.uniform());
}

double random_sign(NoiseStream& draw) {
    return draw.uniform() < 0.5 ? -1.0 : 1.0;
}

double random_factor(NoiseStream& draw, double size) {
    return random_sign(draw) > 0.0 ? 1.0 + size : 1.0 / (1.0 + size);
}

}  // namespace fidservo::selfcheck
