// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The stretches of a carriage's motion (plant/motion.h) that have an exact solution, or one that needs no
// integration: power series, elastic bristles, friction that creeps evenly, steps of linear forces.
#include "plant/motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fidservo::plant {

template <std::size_t size>
WholeSteps Motion<size>::whole_steps(const MacroAxis& axis) {
    WholeSteps steps{axis.longest_step_s, {}};
    for (const DeadZoneBranch branch : {DeadZoneBranch::left, DeadZoneBranch::inside, DeadZoneBranch::right})
        for (const double direction : {-1.0, 1.0})
            for (const bool held : {false, true}) {
                const CarriageFormulaState unseen;  // there are no formulas here
                Motion motion(axis, 0.0, State{}, direction, unseen);
                motion.branch_ = branch;
                motion.direction_ = direction;
                motion.held_ = held;
                motion.start_dry_V_ = axis.parameters.friction.coulomb_V;
                const auto step = affine_step(motion.rates(), steps.duration_s);
                for (std::size_t i = 0; i < size; ++i)
                    std::ranges::copy(step[i], steps.of_way[motion.way()][i].begin());
            }
    return steps;
}

template <std::size_t size>
bool Motion<size>::creeps_evenly(double duration_s) {
    if (has_belt || p_.friction.creep_mm_per_s == 0.0 || axis_.has_bristles || axis_.has_friction_formula)
        return false;
    const double tau_s = p_.time_constant_s, gain = p_.velocity_gain_mm_per_s_per_V;
    const auto creep = balanced_creep(p_.friction, x_[speed], x_[place], coasts(), effective_V(x_));
    constexpr double time_constants = 8.0;
    if (!creep || duration_s * creep->slope_V_s_per_mm * gain < time_constants * tau_s) return false;
    State end = x_;
    end[place] += duration_s * creep->velocity_mm_per_s;
    end[speed] = creep->velocity_mm_per_s;
    direction_ = end[speed] < 0.0 ? -1.0 : 1.0;
    settle(end);
    return true;
}

template <std::size_t size>
std::optional<double> Motion<size>::advance_in_series(double longest_s) {
    if (!axis_.has_series || !is_straight(x_)) return std::nullopt;
    const MotionSeries series = series_of(longest_s);
    const auto reach = [&](double duration_s) {
        return Reached{series.at(duration_s / longest_s), duration_s};
    };
    const auto slack_of = [&](const Reached& there) { return slack(there.end); };
    ++steps_.in_series;
    Reached there =
        reach(longest_s * series.trusted_share(step_place_tolerance_mm, step_speed_tolerance_mm_per_s));
    if (slack_of(there) < 0.0) there = step_to_event(slack(x_), there, reach, slack_of);
    if (!is_straight(there.end)) return std::nullopt;
    settle(there.end);
    return there.duration_s;
}

template <std::size_t size>
std::optional<double> Motion<size>::advance_on_springs(double longest_s) {
    const Friction& friction = p_.friction;
    if (!axis_.has_bristles || !friction.bristles_are_springs || !dry_is_coulomb_ ||
        axis_.has_standing_force || axis_.has_friction_formula || held_ || bend_ == direction_)
        return std::nullopt;
    start_dry_V_ = friction.coulomb_V;
    const double to_sliding_mm = friction.bristle_mm * (1.0 - direction_ * bend_);
    const SpringMotion motion = bristle_motion(friction, p_.time_constant_s, p_.velocity_gain_mm_per_s_per_V,
                                               direction_, voltage_V_, bend_, x_[speed]);
    const auto reach = [&](double duration_s) {
        const auto [way_mm, mm_per_s] = motion.after(duration_s);
        return Reached{{x_[place] + way_mm, mm_per_s}, duration_s};
    };
    const auto slack_of = [&](const Reached& there) {
        return std::min(slack(there.end), to_sliding_mm - direction_ * (there.end[place] - x_[place]));
    };
    const bool is_free = swings_freely(motion);
    Reached there = reach(is_free ? longest_s : std::min(longest_s, motion.until_second_turn_s()));
    if (is_free)
        direction_ = there.end[speed] < 0.0 ? -1.0 : 1.0;
    else if (slack_of(there) < 0.0)
        there = step_to_event(std::min(slack(x_), to_sliding_mm), there, reach, slack_of);
    settle(there.end);
    return there.duration_s;
}

template <std::size_t size>
bool Motion<size>::swings_freely(const SpringMotion& motion) const {
    const Friction& friction = p_.friction;
    const double unbent_mm = x_[place] - friction.bristle_mm * bend_;
    const auto [low_mm, high_mm] = motion.range_mm();
    return p_.play_mm == 0.0 && friction.left_V_s_per_mm == friction.right_V_s_per_mm &&
           x_[place] + low_mm > std::max(unbent_mm - friction.bristle_mm, axis_.driven_low_mm) &&
           x_[place] + high_mm < std::min(unbent_mm + friction.bristle_mm, axis_.driven_high_mm);
}

template <std::size_t size>
MotionSeries Motion<size>::series_of(double duration_s) const {
    const double tau_s = p_.time_constant_s, gain = p_.velocity_gain_mm_per_s_per_V;
    const double without_V = dead_zone_V(p_.dead_zone, branch_, drive_V_, p_.dead_zone_on_motion);
    const double passed =
        dead_zone_V(p_.dead_zone, branch_, drive_V_ + 1.0, p_.dead_zone_on_motion) - without_V;
    const double viscous = direction_ > 0.0 ? p_.friction.right_V_s_per_mm : p_.friction.left_V_s_per_mm;
    const double dry_V = axis_.has_friction ? direction_ * dry_V_at(x_) : 0.0;
    const auto [sine, cosine] = standing_.sine_and_cosine(x_[place]);
    return {{gain * (without_V - dry_V) / tau_s, gain * passed / tau_s, (1.0 + gain * viscous) / tau_s},
            p_.standing,
            sine,
            cosine,
            x_[place],
            x_[speed],
            duration_s};
}

}  // namespace fidservo::plant
