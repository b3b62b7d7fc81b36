// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage's motion between events, and the events that end it: what plant/mechanism.h moves it by.
#include "core/dead_zone.h"
#include "plant/dormand_prince.h"
#include "plant/event_step.h"
#include "plant/macro_axis.h"
#include "plant/motion_error.h"
#include "plant/motion_series.h"
#include "plant/spring_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace fidservo::plant {

/// A motion under a held voltage: of the carriage alone (2 states), or of motor and carriage (4).
template <std::size_t size>
class Motion {
  public:
    using State = std::array<double, size>;
    static constexpr bool has_belt = size == 4;
    static constexpr std::size_t place = 0, speed = 1, stretch = 2, motor = 3;  ///< mm, mm/s, mm, mm/s

    /// @param seen  what formulas see besides the motion; must outlive this object
    Motion(const MacroAxis& axis, double drive_V, const State& start, double bend,
           const CarriageFormulaState& seen)
        : axis_(axis),
          p_(axis.parameters),
          standing_(p_.standing),
          seen_(seen),
          dry_is_coulomb_(p_.friction.stribeck_V == 0.0 && p_.friction.patch.level_V == 0.0 &&
                          p_.friction.coasting_V == 0.0),
          drive_V_(drive_V),
          x_(start),
          bend_(bend) {}

    const State& state() const { return x_; }
    double bend() const { return bend_; }
    const StepCount& steps() const { return steps_; }

    /// Begins a stretch of motion without events. Returns whether anything moves in it.
    bool begin() {
        if (axis_.has_standing_force) standing_.go_to(x_[place]);
        direction_ = x_[speed] < 0.0 ? -1.0 : 1.0;
        const double w_V = drive_V_ + (axis_.has_standing_force ? standing_V(x_) : 0.0);
        branch_ = dead_zone_branch(p_.dead_zone, w_V);
        voltage_V_ = dead_zone_V(p_.dead_zone, branch_, w_V, p_.dead_zone_on_motion);
        if (std::abs(x_[speed]) <= rest_mm_per_s || runs_into_end()) x_[speed] = 0.0;
        held_ = false;
        direction_ = x_[speed] < 0.0 ? -1.0 : 1.0;
        if (x_[speed] != 0.0) return true;
        find_hold_range();
        const double pull = pull_mm_per_s(x_);
        held_ = pull >= hold_low_ && pull <= hold_high_;
        direction_ = pull < hold_low_ ? -1.0 : 1.0;
        return !held_ || !motor_rests();
    }

    /// Moves on by at most `longest_s`, to the next event if there is one before. Returns the time it took.
    double advance(double longest_s) {
        if constexpr (!has_belt) {
            if (const std::optional<double> in_series_s = advance_in_series(longest_s)) return *in_series_s;
            if (const std::optional<double> on_springs_s = advance_on_springs(longest_s))
                return *on_springs_s;
        }
        if (axis_.has_bristles) start_dry_V_ = dry_V_at(x_);
        const State first = rate(x_);
        if (is_whole(longest_s) && is_straight(x_)) {
            const State end = whole_step(first);
            if (slack(end) >= 0.0 && is_straight(end)) {
                settle(end);
                return longest_s;
            }
        }
        if (creeps_evenly(longest_s)) return longest_s;
        Step step = step_from(first, std::min(longest_s, trial_s_));
        double error = plant::error_of<size>(step);
        if (error <= 1.0 && step.duration_s == longest_s && slack(step.end) >= 0.0) {
            settle(step.end);
            return longest_s;
        }
        while (!(error <= 1.0) && step.duration_s > shortest_step_s) {
            step = step_from(
                first, step.duration_s * (std::isfinite(error) ? std::min(fitting_share(error), 0.9) : 0.1));
            error = plant::error_of<size>(step);
        }
        trial_s_ = step.duration_s * (error <= 1.0 ? std::max(fitting_share(error), 0.5) : 5.0);
        if (slack(step.end) < 0.0)
            step = step_to_event(
                slack(x_), step, [&](double h) { return step_from(first, h); },
                [&](const Step& there) { return slack(there.end); });
        settle(step.end);
        return step.duration_s;
    }

    static WholeSteps whole_steps(const MacroAxis& axis) {
        WholeSteps steps{axis.longest_step_s, {}};
        for (const DeadZoneBranch branch :
             {DeadZoneBranch::left, DeadZoneBranch::inside, DeadZoneBranch::right})
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

  private:
    /// Slower than this, under a pull that would sustain no more than this, counts as at rest.
    static constexpr double rest_mm_per_s = 1e-9;

    struct Step : RungeKuttaStep<size> {
        double duration_s;
    };

    struct Reached {
        State end;
        double duration_s;
    };

    /// The index of its mode in WholeSteps, which holds until the next event.
    std::size_t way() const {
        const int branch = static_cast<int>(branch_) + 1;
        return 4 * static_cast<std::size_t>(branch) + (direction_ < 0.0 ? 0U : 2U) + (held_ ? 1U : 0U);
    }

    /// A of x' = A x + b, where forces are linear.
    SquareMatrix<size> rates() const {
        SquareMatrix<size> rates;
        const State at_zero = rate(State{});
        for (std::size_t k = 0; k < size; ++k) {
            State one{};
            one[k] = 1.0;
            const State at_one = rate(one);
            for (std::size_t i = 0; i < size; ++i) rates[i][k] = at_one[i] - at_zero[i];
        }
        return rates;
    }

    bool is_whole(double duration_s) const {
        constexpr double rounding_s = 1e-14;
        const double whole_s = axis_.whole_steps.duration_s;
        return whole_s > 0.0 && std::abs(duration_s - whole_s) < rounding_s;
    }

    /// Whether all forces are linear in the state at `x`: dry friction is constant (bristles fully bent, or
    /// none and faster than creep) or absent, and no patch of raised friction is in reach.
    bool is_straight(const State& x) const {
        const Friction& friction = p_.friction;
        return (!axis_.has_bristles || (bend_ == direction_ && friction.coasting_V == 0.0)) &&
               !friction.patch.reaches(x[place]) &&
               (axis_.has_bristles || (friction.coulomb_V == 0.0 && friction.coasting_V == 0.0) ||
                slides(friction, std::max(0.0, direction_ * x[speed])));
    }

    /// Moves on by a duration where creeping friction makes the equations stiff.
    bool creeps_evenly(double duration_s) {
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

    /// Empty where the motion is no power series, or dry friction changes. Only without a belt.
    std::optional<double> advance_in_series(double longest_s) {
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

    /// Empty unless elastic bristles are bending. Only without a belt.
    std::optional<double> advance_on_springs(double longest_s) {
        const Friction& friction = p_.friction;
        if (!axis_.has_bristles || !friction.bristles_are_springs || !dry_is_coulomb_ ||
            axis_.has_standing_force || axis_.has_friction_formula || held_ || bend_ == direction_)
            return std::nullopt;
        start_dry_V_ = friction.coulomb_V;
        const double to_sliding_mm = friction.bristle_mm * (1.0 - direction_ * bend_);
        const SpringMotion motion =
            bristle_motion(friction, p_.time_constant_s, p_.velocity_gain_mm_per_s_per_V, direction_,
                           voltage_V_, bend_, x_[speed]);
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

    /// Whether no force changes at its reversals, of which stiff springs may cause many in a tick.
    bool swings_freely(const SpringMotion& motion) const {
        const Friction& friction = p_.friction;
        const double unbent_mm = x_[place] - friction.bristle_mm * bend_;
        const auto [low_mm, high_mm] = motion.range_mm();
        return p_.play_mm == 0.0 && friction.left_V_s_per_mm == friction.right_V_s_per_mm &&
               x_[place] + low_mm > std::max(unbent_mm - friction.bristle_mm, axis_.driven_low_mm) &&
               x_[place] + high_mm < std::min(unbent_mm + friction.bristle_mm, axis_.driven_high_mm);
    }

    MotionSeries series_of(double duration_s) const {
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

    State whole_step(const State& first) const {
        const SquareMatrix<4>& step = axis_.whole_steps.of_way[way()];
        State end = x_;
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t k = 0; k < size; ++k) end[i] += step[i][k] * first[k];
        return end;
    }

    Step step_from(const State& first, double h) {
        ++steps_.integrated;
        return {dormand_prince_step([this](const State& x) { return rate(x); }, x_, first, h), h};
    }

    double standing_V(const State& x) const {
        const double by_formula_V =
            axis_.has_force_formula ? formula_V(Port::force, x, direction_, 0.0) : 0.0;
        return standing_.volts(x[place]) + by_formula_V;
    }

    /// The formulas' value at a port; in trial steps past a reversal the direction before it applies.
    double formula_V(Port port, const State& x, double direction, double voltage_V) const {
        double v = x[speed];
        if (axis_.turns_matter) v = direction * std::max(rest_mm_per_s, direction * v);
        return plant::formula_V(p_.formulas, seen_, port, {x[place], v, direction, voltage_V});
    }

    double effective_V(const State& x) const {
        return axis_.has_standing_force
                   ? dead_zone_V(p_.dead_zone, branch_, drive_V_ + standing_V(x), p_.dead_zone_on_motion)
                   : voltage_V_;
    }

    /// The force on the carriage without friction, as the velocity that it would sustain.
    double pull_mm_per_s(const State& x) const {
        if constexpr (has_belt)
            return axis_.belt.per_mm * x[stretch] + axis_.belt.per_mm_per_s * (x[motor] - x[speed]);
        else
            return p_.velocity_gain_mm_per_s_per_V * effective_V(x);
    }

    double friction_V(const State& x) const {
        const double dry_V = dry_V_at(x);
        const double listed_V = axis_.has_bristles
                                    ? bristle_friction_V(p_.friction, x[speed], direction_, bend_at(x, dry_V))
                                    : sliding_friction_V(p_.friction, x[speed], direction_, dry_V);
        return axis_.has_friction_formula
                   ? listed_V + formula_V(Port::friction, x, direction_, effective_V(x))
                   : listed_V;
    }

    /// A velocity against the direction, as in trial steps past a reversal, counts as 0.
    double dry_V_at(const State& x) const {
        return dry_friction_V(p_.friction, std::max(0.0, direction_ * x[speed]), x[place], coasts());
    }
    bool coasts() const { return branch_ == DeadZoneBranch::inside; }

    BristleBend bend_at(const State& x, double dry_V) const {
        if (bend_ == direction_ && dry_is_coulomb_) return {direction_, 0.0};
        return bristle_bend(p_.friction, bend_, x[place] - x_[place], direction_, start_dry_V_, dry_V);
    }

    State rate(const State& x) const {
        const double tau_s = p_.time_constant_s, gain = p_.velocity_gain_mm_per_s_per_V;
        const double pull = pull_mm_per_s(x);
        const double net = axis_.has_friction ? pull - gain * friction_V(x) : pull;
        if constexpr (has_belt) {
            const double share = p_.belt.motor_share;
            const double motor_rate = (gain * effective_V(x) - x[motor] - pull) / (share * tau_s);
            if (held_) return {0.0, 0.0, x[motor], motor_rate};
            return {x[speed], net / ((1.0 - share) * tau_s), x[motor] - x[speed], motor_rate};
        } else {
            return {x[speed], (net - x[speed]) / tau_s};
        }
    }

    /// The range of pulls under which a carriage at rest stays; unbounded towards an end of travel.
    void find_hold_range() {
        const double gain = p_.velocity_gain_mm_per_s_per_V;
        const double bent = axis_.has_bristles ? gain * p_.friction.coulomb_V * bend_ : 0.0;
        const double held = axis_.has_bristles ? 0.0 : gain * breakaway_V(p_.friction, x_[place], coasts());
        hold_low_ = bent - held - rest_mm_per_s;
        hold_high_ = bent + held + rest_mm_per_s;
        if (axis_.has_friction_formula) {
            const double driven_V = effective_V(x_);
            hold_low_ += gain * formula_V(Port::friction, x_, -1.0, driven_V);
            hold_high_ += gain * formula_V(Port::friction, x_, 1.0, driven_V);
        }
        if (x_[place] <= axis_.driven_low_mm) hold_low_ = -std::numeric_limits<double>::infinity();
        if (x_[place] >= axis_.driven_high_mm) hold_high_ = std::numeric_limits<double>::infinity();
    }

    bool motor_rests() {
        if constexpr (!has_belt) return true;
        const double excess = p_.velocity_gain_mm_per_s_per_V * effective_V(x_) - pull_mm_per_s(x_);
        if (std::abs(x_[motor]) > rest_mm_per_s || std::abs(excess) > rest_mm_per_s) return false;
        x_[motor] = 0.0;
        return true;
    }

    /// Distance to the nearest event; negative past it.
    double slack(const State& x) const {
        if (held_) {
            const double pull = pull_mm_per_s(x);
            return std::min(pull - hold_low_, hold_high_ - pull);
        }
        double least = std::min(x[place] - axis_.driven_low_mm, axis_.driven_high_mm - x[place]);
        if (axis_.turns_matter) least = std::min(least, direction_ * x[speed]);
        if (axis_.has_standing_force)
            least = std::min(least, dead_zone_slack_V(p_.dead_zone, branch_, drive_V_ + standing_V(x)));
        return least;
    }

    /// Takes over the end of a step, corrected where an event has just been passed.
    void settle(const State& end) {
        if (axis_.has_bristles && !held_) {
            bend_ = bend_at(end, dry_V_at(end)).bend;
            if (std::abs(bend_ - direction_) < fully_bent_within) bend_ = direction_;
        }
        x_ = end;
        if (held_) return;
        x_[place] = std::clamp(x_[place], axis_.driven_low_mm, axis_.driven_high_mm);
        if (runs_into_end() || (axis_.turns_matter && direction_ * x_[speed] < 0.0)) x_[speed] = 0.0;
    }

    bool runs_into_end() const {
        return (x_[place] <= axis_.driven_low_mm && x_[speed] < 0.0) ||
               (x_[place] >= axis_.driven_high_mm && x_[speed] > 0.0);
    }

    const MacroAxis& axis_;
    const MacroAxisParameters& p_;
    StandingForceNearby standing_;
    const CarriageFormulaState& seen_;
    bool dry_is_coulomb_;
    double drive_V_;
    State x_;
    double bend_, start_dry_V_ = 0.0;                           ///< at x_, where there are bristles
    double trial_s_ = std::numeric_limits<double>::infinity();  ///< step size to try next
    StepCount steps_;
    // Constant until the next event.
    DeadZoneBranch branch_ = DeadZoneBranch::inside;
    bool held_ = false;
    double direction_ = 1.0, voltage_V_ = 0.0, hold_low_ = 0.0, hold_high_ = 0.0;
};

}  // namespace fidservo::plant
