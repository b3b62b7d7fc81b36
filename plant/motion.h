// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The carriage's motion between events, and the events that end it: what plant/mechanism.h moves it by.
//
// Where a formula's force changes with the speed so fast that explicit steps would be far too short, or
// pushes the motion back to an edge of the dead zone from either side, the rest of a tick is moved by
// implicit steps (plant/implicit_step.h), to which that edge is no event.
#include "core/dead_zone.h"
#include "plant/dormand_prince.h"
#include "plant/event_step.h"
#include "plant/implicit_step.h"
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
        const DeadZoneBranch before = branch_;
        look(x_[speed] < 0.0 ? -1.0 : 1.0);
        if (axis_.is_pushed_back && stretches_++ > 0 && branch_ != before && ++crossings_ > 1)
            is_implicit_ = true;
        if (std::abs(x_[speed]) <= rest_mm_per_s || runs_into_end()) x_[speed] = 0.0;
        held_ = false;
        direction_ = x_[speed] < 0.0 ? -1.0 : 1.0;
        if (x_[speed] != 0.0) return true;
        hold_high_ = hold_limit(1.0);
        const double pull = pull_mm_per_s(x_);
        if (axis_.force_turns && pull <= hold_high_) look(-1.0);
        hold_low_ = hold_limit(-1.0);
        const double pull_left = axis_.force_turns ? pull_mm_per_s(x_) : pull;
        held_ = pull_left >= hold_low_ && pull <= hold_high_;
        direction_ = pull_left < hold_low_ ? -1.0 : 1.0;
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
            const double shorter_s =
                step.duration_s * (std::isfinite(error) ? std::min(fitting_share(error), 0.9) : 0.1);
            const bool becomes_implicit =
                axis_.is_pushed_back && !is_implicit_ && shorter_s < least_explicit_share * longest_s;
            is_implicit_ = is_implicit_ || becomes_implicit;
            step = step_from(first, becomes_implicit ? longest_s : shorter_s);
            error = plant::error_of<size>(step);
        }
        if (std::isnan(error)) demand_values_within(first, step.duration_s);
        trial_s_ = step.duration_s * (error <= 1.0 ? std::max(fitting_share(error), 0.5) : 5.0);
        if (slack(step.end) < 0.0)
            step = step_to_event(
                slack(x_), step, [&](double h) { return step_from(first, h); },
                [&](const Step& there) { return slack(there.end); });
        settle(step.end);
        return step.duration_s;
    }

    /// The matrices of whole steps for all modes, where forces are linear.
    static WholeSteps whole_steps(const MacroAxis& axis);

  private:
    /// Slower than this, under a pull that would sustain no more than this, counts as at rest.
    static constexpr double rest_mm_per_s = 1e-9;
    /// Explicit steps of less than this share of a stretch take longer than implicit ones.
    static constexpr double least_explicit_share = 0.02;

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

    // Defined in plant/motion_shortcuts.h.
    /// Moves on by a duration where creeping friction makes the equations stiff.
    bool creeps_evenly(double duration_s);
    /// Empty where the motion is no power series, or dry friction changes. Only without a belt.
    std::optional<double> advance_in_series(double longest_s);
    MotionSeries series_of(double duration_s) const;
    /// Empty unless elastic bristles are bending. Only without a belt.
    std::optional<double> advance_on_springs(double longest_s);
    /// Whether no force changes at its reversals, of which stiff springs may cause many in a tick.
    bool swings_freely(const SpringMotion& motion) const;

    State whole_step(const State& first) const {
        const SquareMatrix<4>& step = axis_.whole_steps.of_way[way()];
        State end = x_;
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t k = 0; k < size; ++k) end[i] += step[i][k] * first[k];
        return end;
    }

    /// A step on trial: its formulas may give any value.
    Step step_from(const State& first, double h) {
        is_on_trial_ = true;
        const auto rate_at = [this](const State& x) { return rate(x); };
        Step step{{}, h};
        if (is_implicit_ && !held_) {
            constexpr int explicit_steps_for_one = 8;  // as many evaluations of forces
            steps_.integrated += explicit_steps_for_one;
            const auto state_at = [this](const State& c, double g, double v) { return at_speed(c, g, v); };
            static_cast<RungeKuttaStep<size>&>(step) =
                implicit_step<size>(state_at, rate_at, speed, x_, first, h);
        } else {
            ++steps_.integrated;
            static_cast<RungeKuttaStep<size>&>(step) = dormand_prince_step(rate_at, x_, first, h);
        }
        is_on_trial_ = false;
        return step;
    }

    /// Throws InputError where a formula has no value within its port's limits at the end of a short step.
    void demand_values_within(const State& first, double duration_s) const {
        State end = x_;
        for (std::size_t i = 0; i < size; ++i) end[i] += duration_s * first[i];
        (void)rate(end);
    }

    /// The state of speed v whose other components solve x = c + g rate(x).
    State at_speed(const State& c, double g, double v) const {
        State x = c;
        x[speed] = v;
        x[place] += g * v;
        if constexpr (has_belt) {
            const double per_s = g / (p_.belt.motor_share * p_.time_constant_s);
            const double gain = p_.velocity_gain_mm_per_s_per_V;
            const auto& [per_mm, per_mm_per_s] = axis_.belt;
            x[motor] += per_s * (gain * effective_V(x) - per_mm * (c[stretch] - g * v) + per_mm_per_s * v);
            x[motor] /= 1.0 + per_s * (1.0 + per_mm_per_s + per_mm * g);
            x[stretch] += g * (x[motor] - v);
        }
        return x;
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
        const CarriageSight sight{x[place], v, direction, voltage_V};
        return is_on_trial_ ? plant::any_formula_V(p_.formulas, seen_, port, sight)
                            : plant::formula_V(p_.formulas, seen_, port, sight);
    }

    /// Looks at the forces on the carriage as it moves, or would move, in a direction.
    void look(double direction) {
        direction_ = direction;
        const double w_V = drive_V_ + (axis_.has_standing_force ? standing_V(x_) : 0.0);
        branch_ = dead_zone_branch(p_.dead_zone, w_V);
        voltage_V_ = dead_zone_V(p_.dead_zone, branch_, w_V, p_.dead_zone_on_motion);
    }

    /// The branch of the dead zone that a voltage is on: until the next event, or at every instant.
    DeadZoneBranch branch_of(double w_V) const {
        return is_implicit_ ? dead_zone_branch(p_.dead_zone, w_V) : branch_;
    }

    double effective_V(const State& x) const {
        if (!axis_.has_standing_force) return voltage_V_;
        const double w_V = drive_V_ + standing_V(x);
        return dead_zone_V(p_.dead_zone, branch_of(w_V), w_V, p_.dead_zone_on_motion);
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
        return dry_friction_V(p_.friction, std::max(0.0, direction_ * x[speed]), x[place], coasts_at(x));
    }
    bool coasts() const { return branch_ == DeadZoneBranch::inside; }
    bool coasts_at(const State& x) const {
        return is_implicit_ && p_.friction.coasting_V != 0.0 && axis_.has_standing_force
                   ? branch_of(drive_V_ + standing_V(x)) == DeadZoneBranch::inside
                   : coasts();
    }

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

    /// The pull up to which a carriage at rest is not moved in a direction; unbounded towards an end of
    /// travel.
    double hold_limit(double direction) const {
        const double gain = p_.velocity_gain_mm_per_s_per_V;
        if (direction < 0.0 ? x_[place] <= axis_.driven_low_mm : x_[place] >= axis_.driven_high_mm)
            return direction * std::numeric_limits<double>::infinity();
        const double bent = axis_.has_bristles ? gain * p_.friction.coulomb_V * bend_ : 0.0;
        const double held = axis_.has_bristles ? 0.0 : gain * breakaway_V(p_.friction, x_[place], coasts());
        const double limit = bent + direction * held + direction * rest_mm_per_s;
        return axis_.has_friction_formula
                   ? limit + gain * formula_V(Port::friction, x_, direction, effective_V(x_))
                   : limit;
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
        if (axis_.has_standing_force && !is_implicit_)
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
    int stretches_ = 0, crossings_ = 0;  ///< begun so far; of them those on another branch of the dead zone
    bool is_implicit_ = false;  ///< whether steps are implicit from now on, across edges of the dead zone
    bool is_on_trial_ = false;  ///< whether the state at which formulas are evaluated is one on trial
    // Constant until the next event.
    DeadZoneBranch branch_ = DeadZoneBranch::inside;
    bool held_ = false;
    double direction_ = 1.0, voltage_V_ = 0.0, hold_low_ = 0.0, hold_high_ = 0.0;
};

}  // namespace fidservo::plant
