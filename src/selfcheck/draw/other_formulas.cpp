// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/other_formulas.h"

#include <array>
#include <numbers>

namespace fidservo::selfcheck {
namespace {

using reference::Departures;

/// Another motor constant: the dead zone stays where it was.
void motor_constant(Departures& rig, double size, NoiseStream& draw) {
    rig.drive.motor = random_factor(draw, size);
}

void stribeck_rational(Departures& rig, double size_V, NoiseStream& draw) {
    rig.friction.stribeck_V = size_V;
    rig.friction.stribeck_speed_mm_per_s = log_uniform(draw, 6.0, 40.0);
    rig.friction.stribeck_is_rational = true;
}

/// Of a lubricant that thins, or thickens, as it is sheared.
void viscous_power(Departures& rig, double size, NoiseStream& draw) {
    rig.friction.viscous_power = size;
    rig.friction.viscous_exponent = random_sign(draw) > 0.0 ? 1.25 : 0.8;
}

/// Of a contact that is ductile, or nearly elastic until it slides.
void presliding_dahl(Departures& rig, double size_V, NoiseStream& draw) {
    const double distance_mm = log_uniform(draw, 0.05, 0.5);
    const double exponent = random_sign(draw) > 0.0 ? 1.5 : 0.2;
    rig.friction.coulomb_V += size_V;
    rig.friction.bristles = reference::Bristles{
        .stiffness_V_per_mm = size_V / distance_mm, .damping_V_s_per_mm = 0.0, .exponent = exponent};
}

void rail_patch_rational(Departures& rig, double size_V, NoiseStream& draw) {
    rig.friction.patch_V = size_V;
    rig.friction.patch_centre_mm = 70.0 + 60.0 * draw.uniform();
    rig.friction.patch_width_mm = log_uniform(draw, 3.0, 10.0);
    rig.friction.patch_is_rational = true;
}

double angle_rad(double share) {
    return std::numbers::pi * (2.0 * share - 1.0);
}

void cogging_skewed(Departures& rig, double size_V, NoiseStream& draw) {
    rig.mechanics.cogging_V = size_V;
    rig.mechanics.cogging_period_mm = log_uniform(draw, 2.0, 20.0);
    rig.mechanics.cogging_phase_rad = angle_rad(draw.uniform());
    rig.mechanics.cogging_skew = log_uniform(draw, 0.3, 0.8);
}

/// A harness that hangs loose near its middle.
void cable_slack(Departures& rig, double size_V_per_mm, NoiseStream& draw) {
    rig.mechanics.cable_V_per_mm = size_V_per_mm;
    rig.mechanics.cable_centre_mm = 60.0 + 80.0 * draw.uniform();
    rig.mechanics.cable_slack_mm = log_uniform(draw, 5.0, 20.0);
}

void encoder_ripple_skewed(Departures& rig, double size_mm, NoiseStream& draw) {
    rig.encoder.ripple_mm = size_mm;
    rig.encoder.ripple_period_mm = log_uniform(draw, 2.0, 20.0);
    rig.encoder.ripple_phase_rad = angle_rad(draw.uniform());
    rig.encoder.ripple_skew = log_uniform(draw, 0.3, 0.8);
}

void airflow_convection(Departures& rig, double size, NoiseStream& draw) {
    rig.heater.convection = random_sign(draw) > 0.0 ? size : -size / (1.0 + size);
}

void heater_gain_cold(Departures& rig, double size, NoiseStream& draw) {
    rig.heater.cold_gain = random_sign(draw) * size;
}

/// As large at 2 mm as a constant shift of the size. The reference rig's wire, whose contraction x times its
/// slope dx/dT is 0.56 mm^2/degC at most, would snap from 3.6 degC on: 2 size / (2 mm)^2 x dx/dT = 1.
void stress_by_hardening_spring(Departures& rig, double size_degC, NoiseStream& draw) {
    constexpr double middle_mm = 2.0;
    rig.hysteresis.stress_shift_degC_per_mm2 = random_sign(draw) * size_degC / (middle_mm * middle_mm);
}

void stroke_fading(Departures& rig, double size, NoiseStream& draw) {
    rig.hysteresis.stroke = 1.0 + random_sign(draw) * size;
    rig.hysteresis.stroke_fading_per_mm = 0.125;
}

void hall_fifth(Departures& rig, double size, NoiseStream& draw) {
    rig.hall.fifth = random_sign(draw) * size;
}

void hall_drift_slowing(Departures& rig, double size_V_per_s, NoiseStream& draw) {
    rig.hall.drift_V_per_s = random_sign(draw) * size_V_per_s;
    rig.hall.drift_slowing_s = log_uniform(draw, 5.0, 20.0);
}

void lens_division(Departures& rig, double size, NoiseStream& draw) {
    rig.camera.division = random_sign(draw) * size;
}

constexpr std::array others{
    EffectDraw{"drive_gain", "motor constant", 2.7e-4, 0.3, motor_constant},
    EffectDraw{"stribeck_friction", "rational", 5.3e-3, 0.4, stribeck_rational},
    EffectDraw{"viscous_friction", "power", 7.6e-4, 0.6, viscous_power},
    EffectDraw{"presliding", "Dahl", 5.1e-4, 0.3, presliding_dahl},
    EffectDraw{"rail_patch", "rational", 4e-3, 0.6, rail_patch_rational},
    EffectDraw{"cogging", "skewed", 5.5e-5, 0.5, cogging_skewed},
    EffectDraw{"cable_force", "slack", 6e-7, 0.01, cable_slack},
    EffectDraw{"encoder_ripple", "skewed", 4.3e-3, 0.3, encoder_ripple_skewed},
    EffectDraw{"airflow", "convection", 7.9e-4, 0.8, airflow_convection},
    EffectDraw{"heater_gain", "cold wire", 1.3e-4, 0.2, heater_gain_cold},
    EffectDraw{"stress_shift", "hardening spring", 6.4e-3, 3.5, stress_by_hardening_spring},
    EffectDraw{"stroke_change", "fading", 5.7e-4, 0.15, stroke_fading},
    EffectDraw{"hall_nonlinearity", "fifth power", 1.9e-3, 0.2, hall_fifth},
    EffectDraw{"hall_drift", "slowing", 5e-5, 5e-3, hall_drift_slowing},
    EffectDraw{"lens_distortion", "division", 3.4e-2, 1.5, lens_division},
};

}  // namespace

std::span<const EffectDraw> other_formulas() {
    return others;
}

std::vector<const EffectDraw*> other_formulas_of(std::string_view class_name) {
    return draws_of(class_name, others);
}

}  // namespace fidservo::selfcheck
