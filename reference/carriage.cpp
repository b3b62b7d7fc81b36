// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/carriage.h"

#include "core/rig.h"
#include "reference/dry_friction.h"
#include "reference/runge_kutta.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace fidservo::reference {

namespace {

/// position, speed, bristle, q, w, stretch of a belt, speed of the motor on it
using Motion = std::array<double, 7>;

Motion motion_of(const CarriageState& state) {
    return {state.position_mm + state.ahead_mm,
            state.speed_mm_per_s,
            state.bristle_mm,
            state.swing_mm,
            state.swing_mm_per_s,
            state.stretch_mm,
            state.motor_mm_per_s};
}

/// @param carriage_mm  where it was
CarriageState state_of(const Motion& x, double carriage_mm, double play_mm) {
    const double now_mm = std::clamp(carriage_mm, x[0] - 0.5 * play_mm, x[0] + 0.5 * play_mm);
    return {now_mm, x[1], x[2], x[3], x[4], x[5], x[6], x[0] - now_mm};
}

double sign_of(double x) {
    return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0);
}

double skewed_sine(double angle_rad, double skew) {
    return std::sin(angle_rad + skew * std::sin(angle_rad));
}

double dead_zone_V(const DeadZone& zone, double u_V) {
    const double beyond_V = std::abs(u_V) - zone.threshold_V;
    return beyond_V < 0.0 ? 0.0 : sign_of(u_V) * (zone.offset_V + zone.slope * beyond_V);
}

/// The forces under a held command. Dry friction has the direction given: within a step the carriage moves
/// one way only.
class Forces {
  public:
    Forces(const CarriageModel& model, double command_V) : model_(model), command_V_(command_V) {}

    double driving_V(double position_mm) const { return driving_force_V(model_, command_V_, position_mm); }

    double viscous_V(double speed_mm_per_s, double direction) const {
        const FrictionDepartures& friction = model_.friction;
        return model_.damping_V_s_per_mm * speed_mm_per_s *
                   (direction < 0.0 ? friction.viscous_backward : friction.viscous_forward) +
               power_V(speed_mm_per_s) +
               friction.drag_V_s2_per_mm2 * speed_mm_per_s * std::abs(speed_mm_per_s);
    }

    /// What pulls at the carriage: the motor, or the belt between them.
    double pull_V(const Motion& x) const {
        const std::optional<Stretch>& belt = model_.mechanics.stretch;
        if (!belt) return driving_V(x[0]);
        const double share = belt->motor_share * (1.0 - belt->motor_share);
        const double damping = 2.0 * belt->damping_ratio *
                               std::sqrt(share * model_.inertia_V_s2_per_mm / belt->compliance_mm_per_V);
        return x[5] / belt->compliance_mm_per_V + damping * (x[6] - x[1]);
    }

    /// Adds what a belt's motor does to the rate of a carriage without one.
    void add_motor(const Motion& x, Motion& rate) const {
        const std::optional<Stretch>& belt = model_.mechanics.stretch;
        if (!belt) return;
        const double damping_V = model_.damping_V_s_per_mm * x[6];
        rate[5] = x[6] - x[1];
        rate[6] =
            (driving_V(x[0]) - damping_V - pull_V(x)) / (belt->motor_share * model_.inertia_V_s2_per_mm);
    }

    double carriage_inertia() const {
        const std::optional<Stretch>& belt = model_.mechanics.stretch;
        return model_.inertia_V_s2_per_mm * (belt ? 1.0 - belt->motor_share : 1.0);
    }

    Motion rate(const Motion& x, double direction, Contact contact) const {
        const double omega = 2.0 * std::numbers::pi * model_.flexure.frequency_hz;
        const double swing = x[4] - model_.flexure.coupling * x[1];
        const double swing_rate = -2.0 * model_.flexure.damping_ratio * omega * swing - omega * omega * x[3];
        Motion rate{0.0, 0.0, 0.0, swing, swing_rate, 0.0, 0.0};
        add_motor(x, rate);
        if (direction == 0.0) return rate;
        const DryFriction dry = dry_friction(model_, x[0], x[1], x[2], direction, contact);
        double net_V =
            pull_V(x) - dry.force_V - viscous_V(x[1], x[1] == 0.0 ? direction : x[1]) - smooth_friction_V(x);
        if (model_.mechanics.stretch) net_V += model_.damping_V_s_per_mm * x[1];  // that is the motor's
        rate[0] = x[1];
        rate[1] = net_V / carriage_inertia();
        rate[2] = dry.bristle_mm_per_s;
        return rate;
    }

    /// Which way the carriage moves next: +1, -1, or 0 for held by friction or by an end stop.
    double direction(const Motion& x) const {
        double way = sign_of(x[1]);
        if (way == 0.0) {
            const double force_V = pull_V(x) - bristle_force_V(model_, x[2]);
            way = std::abs(force_V) > breakaway_V(model_, x[0]) ? sign_of(force_V) : 0.0;
        }
        const bool blocked = (way > 0.0 && x[0] >= model_.high_mm) || (way < 0.0 && x[0] <= model_.low_mm);
        return blocked ? 0.0 : way;
    }

  private:
    double power_V(double speed_mm_per_s) const {
        const FrictionDepartures& friction = model_.friction;
        if (friction.viscous_power == 0.0) return 0.0;
        constexpr double equal_mm_per_s = 100.0;
        const double share = std::pow(std::abs(speed_mm_per_s) / equal_mm_per_s, friction.viscous_exponent);
        return friction.viscous_power * model_.damping_V_s_per_mm *
               std::copysign(equal_mm_per_s * share, speed_mm_per_s);
    }

    /// It fades towards rest, where other friction alone holds.
    double smooth_friction_V(const Motion& x) const {
        const Discrepancy& discrepancy = model_.discrepancy;
        if (discrepancy.function.size == 0.0 || discrepancy.acts_on != ActsOn::carriage_friction) return 0.0;
        constexpr double fading_mm_per_s = 10.0;
        const double share = -std::expm1(-std::pow(x[1] / fading_mm_per_s, 2));
        if (discrepancy.depends_on == DependsOn::carriage_speed) return share * discrepancy.function(x[1]);
        return share * sign_of(x[1]) * discrepancy.function(x[0]);
    }

    const CarriageModel& model_;
    double command_V_;
};

/// Has the motion passed the end of its phase: an end stop, or a reversal under rigid dry friction?
bool is_past(const CarriageModel& model, const Motion& x, double direction) {
    return x[0] > model.high_mm || x[0] < model.low_mm ||
           (is_rigid(model.friction) && x[1] * direction < 0.0);
}

/// One step within a phase, cut short where the phase ends. @return its length in s
double step_phase(const CarriageModel& model, const Forces& forces, Motion& x, double direction,
                  Contact contact, double h_s) {
    const auto moved = [&](double way_s) {
        return runge_kutta_step(x, way_s,
                                [&](const Motion& there) { return forces.rate(there, direction, contact); });
    };
    const Motion whole = moved(h_s);
    if (direction == 0.0 || !is_past(model, whole, direction)) {
        x = whole;
        return h_s;
    }
    double before_s = 0.0, after_s = h_s;
    constexpr int bisections = 60;
    for (int i = 0; i < bisections; ++i) {
        const double middle_s = 0.5 * (before_s + after_s);
        (is_past(model, moved(middle_s), direction) ? after_s : before_s) = middle_s;
    }
    x = moved(after_s);
    x[0] = std::clamp(x[0], model.low_mm, model.high_mm);
    x[1] = 0.0;
    return after_s;
}

}  // namespace

CarriageModel make_carriage(const Rig& rig, const Departures& departures) {
    CarriageModel model;
    const double tau_s = -rig.tick_s / std::log(rig.macro.velocity_pole);
    model.low_mm = rig.macro.low_mm - 0.5 * departures.mechanics.play_mm;
    model.high_mm = rig.macro.high_mm + 0.5 * departures.mechanics.play_mm;
    model.damping_V_s_per_mm = 1.0 / rig.macro.velocity_gain_mm_per_s_per_V;
    model.inertia_V_s2_per_mm = departures.mechanics.payload * tau_s * model.damping_V_s_per_mm;
    model.command_limit_V = rig.macro.command_limit_V;
    model.dead_zone = rig.macro.dead_zone;
    model.drive = departures.drive;
    model.friction = departures.friction;
    model.mechanics = departures.mechanics;
    model.flexure = departures.flexure;
    model.discrepancy = departures.discrepancy;
    return model;
}

double driving_force_V(const CarriageModel& model, double command_V, double position_mm) {
    const MechanicsDepartures& place = model.mechanics;
    const double saturated_V = std::clamp(command_V, -model.command_limit_V, model.command_limit_V);
    double u_V = model.drive.gain * saturated_V + model.drive.offset_V;
    if (place.cogging_V != 0.0) {
        const double angle = 2.0 * std::numbers::pi * position_mm / place.cogging_period_mm;
        u_V +=
            place.cogging_V * (skewed_sine(angle + place.cogging_phase_rad, place.cogging_skew) +
                               place.cogging_second * std::sin(2.0 * angle + place.cogging_second_phase_rad));
    }
    if (place.cable_V_per_mm != 0.0) {
        const double from_centre_mm = position_mm - place.cable_centre_mm;
        const double off_mm =
            from_centre_mm - std::clamp(from_centre_mm, -place.cable_slack_mm, place.cable_slack_mm);
        u_V -= place.cable_V_per_mm * (off_mm + place.cable_cubic_per_mm2 * std::pow(off_mm, 3));
    }
    if (model.discrepancy.acts_on == ActsOn::carriage_force) u_V += model.discrepancy.function(position_mm);
    const double on_motion = model.friction.dead_zone_on_motion;
    return model.drive.motor *
           ((1.0 - on_motion) * dead_zone_V(model.dead_zone, u_V) + on_motion * model.dead_zone.slope * u_V);
}

void advance(const CarriageModel& model, CarriageState& state, double command_V, double h_s) {
    const Forces forces(model, command_V);
    Motion x = motion_of(state);
    constexpr int most_phases = 10'000;  // a guard: a step has one phase, or two where the carriage stops
    for (int phase = 0; h_s > 0.0 && phase < most_phases; ++phase) {
        const double direction = forces.direction(x);
        if (direction == 0.0) x[1] = 0.0;
        const ContactStep contact = contact_step(model, x[0], x[1], h_s);
        h_s -= step_phase(model, forces, x, direction, contact.kind, contact.length_s);
        if (contact.kind == Contact::bristles_in_equilibrium)
            x[2] = sign_of(x[1]) * equilibrium_bristle_mm(model, x[0], x[1]);
    }
    state = state_of(x, state.position_mm, model.mechanics.play_mm);
}

}  // namespace fidservo::reference
