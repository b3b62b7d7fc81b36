// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/true_formula.h"

#include "core/rig.h"

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace fidservo::selfcheck {

namespace {

using fmt::format;
using Memory = FormulaEffect::Memory;

/// At a port, with what it remembers.
struct Text {
    std::string_view acts_on, block;
    std::string formula;
    std::optional<Memory> memory = {};
};

using Maybe = std::optional<Text>;

/// A rig with one effect, beside its file.
struct Departed {
    const reference::Departures& by;
    const Rig& rig;
    const Rig& nominal;

    double volts_s_per_mm() const { return 1.0 / nominal.macro.velocity_gain_mm_per_s_per_V; }
};

/// Which way dry friction acts: with the direction, or in a lubricated contact with tanh(speed / creep).
std::string against_motion(const Departed& rig) {
    const double creep_mm_per_s = rig.by.friction.creep_mm_per_s;
    return creep_mm_per_s == 0.0 ? "direction" : format("tanh(speed / {})", creep_mm_per_s);
}

Text friction(std::string formula) {
    return {"macro.friction", "macro.friction", std::move(formula)};
}

Text force(std::string formula) {
    return {"macro.force", "macro.mechanics", std::move(formula)};
}

Text drive(std::string formula) {
    return {"macro.drive_voltage", "macro.drive", std::move(formula)};
}

Text heater(std::string formula) {
    return {"micro.heater_power", "micro.heater", std::move(formula)};
}

Text hall(std::string formula) {
    return {"micro.hall_voltage", "micro.hall", std::move(formula)};
}

Text camera(std::string_view port, double value) {
    return {port, "camera.geometry", format("{}", value)};
}

/// What is wrong with a rate that approaches (heater_power) with a time constant, in one of the regimes.
Text rate(char regime, double tau_s, double factor) {
    return {"micro.heat_flow", "micro.heater",
            format("{} * (heater_power - wire_temp + room_temp) * (heater_power {} wire_temp - room_temp)",
                   (1.0 / factor - 1.0) / tau_s, regime)};
}

/// In spans, -1 to 1 over the sensor's range.
std::string along_hall(const Departed& rig) {
    const HallParameters& hall = rig.nominal.micro->hall;
    return format("((platform - {}) / {})", hall.centre_mm, hall.half_range_mm);
}

std::string hall_curve(const Departed& rig) {
    const HallParameters& hall = rig.nominal.micro->hall;
    return format("({} * {} * ({} - {} * {}^2))", hall.span_V, along_hall(rig), 1.0 + hall.cubic, hall.cubic,
                  along_hall(rig));
}

Maybe of_drive(std::string_view effect, const Departed& rig) {
    const reference::DriveDepartures& drive_by = rig.by.drive;
    if (effect == "drive_gain") return drive(format("{} * command", drive_by.gain - 1.0));
    if (effect == "drive_delay") {
        Text text = drive("late - command");
        text.memory = {"late", Memory::Kind::delay, "command", format("{}", drive_by.delay_s)};
        return text;
    }
    if (effect == "drive_offset") return force(format("{}", drive_by.offset_V));
    if (effect == "drive_fading") return drive(format("-{} * time * command", drive_by.fading_per_s));
    return {};
}

Maybe of_friction(std::string_view effect, const Departed& rig) {
    const reference::FrictionDepartures& by = rig.by.friction;
    const std::string against = against_motion(rig);
    if (effect == "coulomb_friction" && by.dead_zone_on_motion == 0.0)
        return friction(format("{} * {}", by.coulomb_V, against));
    if (effect == "stribeck_friction")
        return friction(format("{} * exp(-(abs(speed) / {})^{}) * {}", by.stribeck_V,
                               by.stribeck_speed_mm_per_s, by.stribeck_exponent, against));
    if (effect == "viscous_friction")
        return friction(format("{} * speed", (by.viscous_forward - 1.0) * rig.volts_s_per_mm()));
    if (effect == "friction_asymmetry")
        return friction(format("{} * abs(speed)", (by.viscous_forward - 1.0) * rig.volts_s_per_mm()));
    if (effect == "quadratic_drag") return friction(format("{} * speed * abs(speed)", by.drag_V_s2_per_mm2));
    if (effect == "rail_patch")
        return friction(format("{} * exp(-((place - {}) / {})^2 / 2) * {}", by.patch_V, by.patch_centre_mm,
                               by.patch_width_mm, against));
    return {};
}

Maybe of_mechanics(std::string_view effect, const Departed& rig) {
    const reference::MechanicsDepartures& by = rig.by.mechanics;
    if (effect == "cogging")
        return force(format("{0} * (sin(2 * pi * place / {1} + {2}) + {3} * sin(4 * pi * place / {1} + {4}))",
                            by.cogging_V, by.cogging_period_mm, by.cogging_phase_rad, by.cogging_second,
                            by.cogging_second_phase_rad));
    if (effect == "cable_force")
        return force(format("-{0} * ((place - {1}) + {2} * (place - {1})^3)", by.cable_V_per_mm,
                            by.cable_centre_mm, by.cable_cubic_per_mm2));
    return {};
}

Maybe of_encoder(std::string_view effect, const Departed& rig) {
    const reference::EncoderDepartures& by = rig.by.encoder;
    const auto encoder = [](std::string formula) {
        return Text{"macro.encoder", "macro.encoder", std::move(formula)};
    };
    if (effect == "encoder_scale") return encoder(format("{} * place", by.scale - 1.0));
    if (effect == "encoder_ripple")
        return encoder(format("{} * sin(2 * pi * place / {} + {})", by.ripple_mm, by.ripple_period_mm,
                              by.ripple_phase_rad));
    if (effect == "encoder_bow")
        return encoder(format("{} * (place - {})^2", by.bow_per_mm, by.bow_centre_mm));
    return {};
}

Maybe of_heater(std::string_view effect, const Departed& rig) {
    const reference::HeaterDepartures& by = rig.by.heater;
    const HeaterParameters& nominal = rig.nominal.micro->heater;
    if (effect == "ambient_temperature") return heater(format("{}", by.ambient_degC));
    if (effect == "heater_gain") return heater(format("{} * heater_power", by.gain - 1.0));
    if (effect == "heating_lag") return rate('>', nominal.heating_tau_s, by.heating_tau);
    if (effect == "airflow") return rate('<', nominal.cooling_tau_s, by.cooling_tau);
    if (effect == "heater_delay") {
        Text text = heater("late - heater_power");
        text.memory = {"late", Memory::Kind::delay, "heater_power", format("{}", by.delay_s)};
        return text;
    }
    if (effect == "heater_curvature")
        return heater(format("{} * heater_power * (2 * heater_power / {} - 1)", by.curvature,
                             nominal.gain_degC_per_V * (nominal.limit_V - nominal.onset_V)));
    if (effect == "heater_onset")
        return heater(format("{} * max(0, min(heater_command, {}) - {}) - heater_power",
                             nominal.gain_degC_per_V, nominal.limit_V, rig.rig.micro->heater.onset_V));
    return {};
}

Maybe of_wire(std::string_view effect, const Departed& rig) {
    const reference::HysteresisDepartures& by = rig.by.hysteresis;
    if (effect == "stress_shift")
        return Text{"micro.transformation", "micro.hysteresis", format("{}", by.stress_shift_degC)};
    if (effect == "stroke_change")
        return Text{"micro.contraction", "micro.hysteresis", format("{} * contraction", by.stroke - 1.0)};
    return {};
}

Maybe of_hall(std::string_view effect, const Departed& rig) {
    const reference::HallDepartures& by = rig.by.hall;
    const HallParameters& nominal = rig.nominal.micro->hall;
    if (effect == "hall_gain")
        return hall(format("{} * {} + {} * {}", by.supply * by.gain - 1.0, hall_curve(rig), by.supply - 1.0,
                           nominal.mid_V));
    if (effect == "hall_offset") return hall(format("{}", by.offset_V));
    if (effect == "hall_nonlinearity")
        return hall(format("{0} * {1} * (1 - {1}^2) + {2} * {1}^3", by.cubic * nominal.span_V,
                           along_hall(rig), by.cube * nominal.span_V));
    if (effect == "hall_drift")
        return by.drift_settling_s == 0.0
                   ? hall(format("{} * time", by.drift_V_per_s))
                   : hall(format("{} * (1 - exp(-time / {}))", by.drift_V_per_s * by.drift_settling_s,
                                 by.drift_settling_s));
    if (effect == "hall_warmth") return hall(format("{} * (wire_temp - room_temp)", by.warm_V_per_degC));
    if (effect == "hall_crosstalk") return hall(format("{} * drive", by.crosstalk_V_per_V));
    return {};
}

Maybe of_view(std::string_view effect, const Departed& rig) {
    const reference::CameraDepartures& by = rig.by.camera;
    if (effect == "pixel_scale") return camera("camera.scale", by.scale - 1.0);
    if (effect == "camera_rotation") return camera("camera.rotation", by.rotation_rad);
    if (effect == "camera_latency")
        return Text{"camera.frame_time", "camera.timing", format("{}", by.latency_s)};
    if (effect == "clock_skew")
        return Text{"camera.frame_time", "camera.timing", format("{} * time", by.clock_skew)};
    if (effect == "tag_pitch")
        return Text{
            "plate.tag_x", "plate",
            format("{} * tag_x", rig.rig.fiducials->pitch_x_mm / rig.nominal.fiducials->pitch_x_mm - 1.0)};
    return {};
}

struct Reason {
    std::string_view effect, why;
};

constexpr std::array reasons{
    Reason{"coulomb_friction", "where part of the dead zone acts on the motion, two ports change at once"},
    Reason{"presliding", "bristles bend within a tick"},
    Reason{"payload", "the carriage's acceleration is no port's variable: it is what the forces make"},
    Reason{"belt_compliance", "motor and carriage swing against each other within a tick"},
    Reason{"backlash", "what drives the carriage moves apart from it"},
    Reason{"second_thermal_mass", "the mass conducts: it has more states than an equation may"},
    Reason{"macro_coupling", "the platform swings: two states of its own"},
    Reason{"camera_tilt", "it turns about two axes: two ports"},
    Reason{"lens_distortion", "no port bends the image"},
    Reason{"duhem_hysteresis", "another hysteresis replaces the wire's"},
    Reason{"pixel_aspect", "no port scales one axis of the image alone"},
    Reason{"tag_side", "no port changes the size of tags"},
    Reason{"macro_controller_gain", "controllers have no port"},
    Reason{"micro_controller_gain", "controllers have no port"},
};

constexpr std::array rooms{of_drive,  of_friction, of_mechanics, of_encoder,
                           of_heater, of_wire,     of_hall,      of_view};

}  // namespace

std::optional<FormulaEffect> as_formula(const TrueRig& rig, const Rig& nominal, std::string_view effect) {
    const Departed departed{rig.departures, rig.rig, nominal};
    for (const auto& room : rooms) {
        Maybe text = room(effect, departed);
        if (!text) continue;
        FormulaEffect formula;
        formula.name = "truth";
        formula.acts_on = text->acts_on;
        formula.block = text->block;
        formula.formula = "whole * (" + text->formula + ")";
        formula.parameters.push_back({.name = "whole", .low = 0.0, .high = 1.0, .typical = 1.0});
        if (text->memory) formula.memories.push_back(*std::move(text->memory));
        return formula;
    }
    return {};
}

std::string_view why_not_a_formula(std::string_view effect) {
    const auto found = std::ranges::find(reasons, effect, &Reason::effect);
    return found == reasons.end() ? std::string_view{} : found->why;
}

}  // namespace fidservo::selfcheck
