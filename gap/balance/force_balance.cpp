// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/force_balance.h"

#include "core/dead_zone.h"
#include "core/rig.h"
#include "gap/candidates/coupling.h"
#include "gap/links/carriage_path.h"
#include "gap/links/carriage_run.h"
#include "plant/effects/catalogue.h"
#include "plant/transmission.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// As errors of the windows wanted: all that the supports need of them is where they are.
Errors where_wanted(const Evidence& evidence, const Wanted& wanted) {
    const std::vector<Window>& windows = evidence.windows();
    Errors errors(windows.empty() ? 0 : windows.back().end, not_a_number);
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (wanted[w] != 0 && windows[w].signal == Signal::encoder)
            std::fill(errors.begin() + static_cast<std::ptrdiff_t>(windows[w].begin),
                      errors.begin() + static_cast<std::ptrdiff_t>(windows[w].end), 0.0F);
    return errors;
}

bool has_belt(const plant::MacroAxisParameters& axis) {
    return axis.belt.compliance_mm_per_V > plant::least_compliance_mm_per_V;
}

/// A carriage on its way, as its readings say.
struct OnItsWay {
    double time_s, position_mm, velocity_mm_per_s, direction;
};

/// What the formulas of some ports come to, V.
/// @param voltage_V  what the dead zone leaves of drive and forces
double formulas_V(const plant::MacroAxisParameters& axis, std::initializer_list<plant::Port> ports,
                  double command_V, const OnItsWay& at, double voltage_V) {
    plant::CarriageFormulaState seen;
    seen.time_s = at.time_s;
    seen.command_V = plant::saturated_V(axis, command_V);
    double sum_V = 0.0;
    for (const plant::Port port : ports)
        if (axis.formulas.act(port))
            sum_V += plant::formula_V(axis.formulas, seen, port,
                                      {at.position_mm, at.velocity_mm_per_s, at.direction, voltage_V});
    return sum_V;
}

/// What moves whatever the voltage drives, in V, at a place of the carriage.
double effective_V(const plant::MacroAxisParameters& axis, double command_V, const OnItsWay& at) {
    double drive_V = plant::drive_voltage_V(axis, command_V) + axis.drive_bias_V +
                     plant::StandingForceNearby(axis.standing).volts(at.position_mm);
    if (axis.formulas.any())
        drive_V += formulas_V(axis, {plant::Port::drive_voltage, plant::Port::force}, command_V, at, 0.0);
    return dead_zone_V(axis.dead_zone, drive_V, axis.dead_zone_on_motion);
}

/// @param driven_V  what moves the carriage
double friction_V(const plant::MacroAxisParameters& axis, double command_V, const OnItsWay& at,
                  double driven_V) {
    const double dry_V =
        plant::dry_friction_V(axis.friction, std::abs(at.velocity_mm_per_s), at.position_mm, driven_V == 0.0);
    const double listed_V =
        plant::sliding_friction_V(axis.friction, at.velocity_mm_per_s, at.direction, dry_V);
    if (!axis.formulas.any()) return listed_V;
    return listed_V + formulas_V(axis, {plant::Port::friction}, command_V, at, driven_V);
}

/// Of a motor whose belt's other end goes the way that a carriage was recorded to go, from rest: what the
/// belt pulls the carriage with, row by row, V. By the trapezoidal rule.
/// @param stretch  length of a count over the nominal one
std::vector<double> belt_pull_V(const plant::MacroAxisParameters& axis, double tick_s,
                                const std::vector<StageRow>& rows, const std::vector<double>& readings_mm,
                                double stretch, std::size_t late) {
    const double gain = axis.velocity_gain_mm_per_s_per_V;
    const plant::BeltForce belt = plant::belt_force(axis.belt, gain, axis.time_constant_s);
    const double inertia = 2.0 * axis.belt.motor_share * axis.time_constant_s / tick_s;
    const double resistance = inertia + 1.0 + 0.5 * belt.per_mm * tick_s + belt.per_mm_per_s;
    std::vector<double> pull_V(rows.size(), 0.0);
    double carriage_mm = 0.0, motor_mm = 0.0, motor_mm_per_s = 0.0;
    bool is_under_way = false;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (!std::isfinite(readings_mm[row])) continue;
        const double from_mm = carriage_mm;
        carriage_mm = stretch * readings_mm[row];
        if (!is_under_way) {
            motor_mm = carriage_mm;
            is_under_way = true;
            continue;
        }
        const double command_V = rows[row - std::min(late + 1, row)].macro_command_V;
        const double mean_mm_per_s =
            (inertia * motor_mm_per_s +
             gain * effective_V(axis, command_V,
                                {seconds(rows[row].time_ns - rows.front().time_ns), carriage_mm,
                                 motor_mm_per_s, std::copysign(1.0, motor_mm_per_s)}) -
             belt.per_mm * (motor_mm - 0.5 * (from_mm + carriage_mm)) +
             belt.per_mm_per_s * (carriage_mm - from_mm) / tick_s) /
            resistance;
        const double stretch_mm = motor_mm - from_mm;
        motor_mm += tick_s * mean_mm_per_s;
        motor_mm_per_s = 2.0 * mean_mm_per_s - motor_mm_per_s;
        pull_V[row] = (belt.per_mm * (motor_mm - carriage_mm) +
                       belt.per_mm_per_s * (motor_mm - carriage_mm - stretch_mm) / tick_s) /
                      gain;
    }
    return pull_V;
}

/// Of the readings, what moves the carriage as they say. With a belt its motor has a share of the mass and
/// all back-EMF.
struct Needed {
    double V_per_mm_per_s2, V_per_mm_per_s;
};

Needed needed_by(const plant::MacroAxisParameters& axis, double stretch) {
    const double per_V = stretch / axis.velocity_gain_mm_per_s_per_V;
    if (!has_belt(axis)) return {axis.time_constant_s * per_V, per_V};
    return {(1.0 - axis.belt.motor_share) * axis.time_constant_s * per_V, 0.0};
}

plant::PlantParameters with_effects(const Rig& rig, const Hypothesis& hypothesis) {
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, hypothesis);
    return parameters;
}

/// Length of a count over the rig file's.
double stretch_of(const Rig& rig, const plant::PlantParameters& parameters) {
    return parameters.encoder.resolution_mm / rig.macro.encoder_resolution_mm;
}

}  // namespace

ForceBalance::ForceBalance(const Evidence& evidence, const Wanted& wanted, const Hypothesis& known,
                           std::size_t half_support)
    : evidence_(evidence), forces_(evidence, where_wanted(evidence, wanted), half_support) {
    const plant::Encoder encoder = with_effects(evidence.rig(), known).encoder;
    const auto by_reading_mm = [&](const SlidingRow& row) {
        return encoder.is_straight() ? row.reading_mm
                                     : position_mm(encoder, row.reading_mm / encoder.resolution_mm);
    };
    velocity_ = forces_.mean_velocity(by_reading_mm);
    acceleration_ = forces_.mean_acceleration(by_reading_mm);
    for (const Recording& recording : evidence.recordings())
        readings_mm_.push_back(readings_mm(recording, evidence.rig().macro));
}

Errors ForceBalance::excess(const Hypothesis& hypothesis) const {
    return excess(with_effects(evidence_.rig(), hypothesis));
}

Errors ForceBalance::excess(const plant::PlantParameters& parameters) const {
    const plant::MacroAxisParameters& axis = parameters.axis;
    const double stretch = stretch_of(evidence_.rig(), parameters);
    const auto late = static_cast<std::size_t>(std::lround(axis.delay_s / parameters.tick_s));
    const auto rows_of = [&](std::size_t run) -> const std::vector<StageRow>& {
        return evidence_.recordings()[run].rows;
    };
    std::vector<std::vector<double>> pull_V;
    for (std::size_t run = 0; has_belt(axis) && run < readings_mm_.size(); ++run)
        pull_V.push_back(
            belt_pull_V(axis, parameters.tick_s, rows_of(run), readings_mm_[run], stretch, late));
    // What a command does acts from its row to the next.
    const auto command_V = [&](const SlidingRow& row) {
        return rows_of(row.run)[row.row - std::min(late, row.row)].macro_command_V;
    };
    const auto driven_V = [&](const SlidingRow& row, const OnItsWay& at) {
        if (!pull_V.empty()) return 0.5 * (pull_V[row.run][row.row] + pull_V[row.run][row.row + 1]);
        return effective_V(axis, command_V(row), at);
    };
    const double half_tick_s = 0.5 * parameters.tick_s;
    const Column column = forces_.of_force(0, [&](const SlidingRow& row) {
        const OnItsWay at{row.time_s, stretch * (row.position_mm + half_tick_s * row.velocity_mm_per_s),
                          stretch * (row.velocity_mm_per_s + half_tick_s * row.acceleration_mm_per_s2),
                          row.direction};
        const double driving_V = driven_V(row, at);
        return driving_V - friction_V(axis, command_V(row), at, driving_V);
    });
    const Needed needs = needed_by(axis, stretch);
    Errors excess(supports());
    for (std::size_t k = 0; k < excess.size(); ++k) {
        const double needed_V =
            needs.V_per_mm_per_s2 * acceleration_.values[k] + needs.V_per_mm_per_s * velocity_.values[k];
        excess[k] = static_cast<float>((column.values[k] - needed_V) / deviations);
    }
    return excess;
}

Errors ForceBalance::excess_in_own_deviations(const Hypothesis& hypothesis) const {
    const plant::PlantParameters parameters = with_effects(evidence_.rig(), hypothesis);
    const Needed needs = needed_by(parameters.axis, stretch_of(evidence_.rig(), parameters));
    const double deviation = forces_.deviation_of(needs.V_per_mm_per_s2, needs.V_per_mm_per_s);
    Errors all = excess(parameters);
    for (float& excess : all) excess /= static_cast<float>(deviation);
    return all;
}

double ForceBalance::way_mm() const {
    if (forces_.rows().empty()) return 0.0;
    const auto [least, most] = std::ranges::minmax(forces_.rows(), {}, &SlidingRow::position_mm);
    return most.position_mm - least.position_mm;
}

bool shows_in_balance(const plant::Effect& effect) {
    if (!moves_carriage(effect)) return false;
    plant::PlantParameters parameters;
    plant::put(effect, parameters, plant::typical_setting(effect).values);
    const plant::Formulas& formulas = parameters.axis.formulas;
    return parameters.axis.play_mm == 0.0 && !formulas.remember() &&
           !formulas.use(plant::carriage_variable::way);
}

}  // namespace fidservo::gap
