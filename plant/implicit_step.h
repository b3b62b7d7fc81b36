// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step of a singly diagonally implicit Runge-Kutta pair of order 4 and 3, L-stable and stiffly accurate:
// Hairer and Wanner, Solving Ordinary Differential Equations II (1996), section IV.6, Table 6.5.
//
// It follows forces that change with the speed faster than explicit steps can follow, and forces that jump
// at a speed where the motion is pushed back from either side: there a stage's speed is the one at which its
// equation changes sign, which is the motion along the jump (Filippov's; Acary and Brogliato, Numerical
// Methods for Nonsmooth Dynamical Systems, 2008, section 9.2). The pair is no better than its error estimate
// where only some of its stages are on a jump; a step that comes to a jump or leaves it is one of the
// implicit Euler method, which ends on the jump and not beside it.
#include "plant/dormand_prince.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace fidservo::plant {

/// Where a function changes sign.
struct SignChange {
    double at;
    bool jumps;  ///< the function is so steep there that it may as well jump
};

/// Where a function changes sign, if `first` and `second`, or points beyond the second one, are on either
/// side of that. By regula falsi (Illinois variant), every third point halving the interval.
/// @param resolution  in the argument
/// @return empty where no change of sign was found, or the function is no number
template <class Function>
std::optional<SignChange> sign_change(const Function& function, double first, double second,
                                      double resolution) {
    constexpr int most_doublings = 20, most_points = 400;
    constexpr double steep = 1e3;
    double a = first, at_a = function(a);
    if (at_a == 0.0) return SignChange{a, false};
    double b = second, at_b = function(b);
    for (int k = 0; at_a * at_b > 0.0; ++k) {
        if (k == most_doublings) return std::nullopt;
        b += 2.0 * (b - a);
        at_b = function(b);
    }
    if (!std::isfinite(at_a * at_b)) return std::nullopt;
    double weight_a = at_a, weight_b = at_b;
    int last_side = 0;
    for (int point = 1; std::abs(b - a) > resolution && at_b != 0.0; ++point) {
        const double share = point % 3 == 0 ? 0.5 : weight_a / (weight_a - weight_b);
        const double middle = a + share * (b - a);
        if (point == most_points || middle == a || middle == b) break;
        const double value = function(middle);
        if (std::isnan(value)) return std::nullopt;
        const bool replaces_a = value * at_a > 0.0;
        if (replaces_a) {
            a = middle;
            at_a = weight_a = value;
            if (last_side == -1) weight_b *= 0.5;
        } else {
            b = middle;
            at_b = weight_b = value;
            if (last_side == 1) weight_a *= 0.5;
        }
        last_side = replaces_a ? -1 : 1;
    }
    return SignChange{std::abs(at_a) < std::abs(at_b) ? a : b,
                      at_b != 0.0 && std::abs(at_b - at_a) > steep * std::abs(b - a)};
}

/// An implicit stage: the state x = c + g rate(x), and its rate.
template <std::size_t size>
struct ImplicitStage {
    std::array<double, size> state, slope;
    bool jumps;  ///< it is on a jump of the forces, where its rate is the one of the motion along the jump
};

/// @param state_at, rate, speed  as in implicit_step()
/// @return empty where there is none, as in a step that is too long
template <std::size_t size, class StateAt, class Rate>
std::optional<ImplicitStage<size>> implicit_stage(const StateAt& state_at, const Rate& rate,
                                                  std::size_t speed, const std::array<double, size>& known,
                                                  double g) {
    constexpr double resolution = 1e-11;
    const auto excess = [&](double v) { return v - known[speed] - g * rate(state_at(known, g, v))[speed]; };
    const double guess = known[speed] - excess(known[speed]);
    const std::optional<SignChange> v = sign_change(excess, known[speed], guess, resolution);
    if (!v) return std::nullopt;
    ImplicitStage<size> stage{state_at(known, g, v->at), {}, v->jumps};
    for (std::size_t i = 0; i < size; ++i) stage.slope[i] = (stage.state[i] - known[i]) / g;
    return stage;
}

/// One step over a duration h. Its end is NaN where a stage has no solution, as in a step that is too long.
/// @param state_at  the state (c, g, v) whose component `speed` is v and whose others solve x = c + g rate(x)
/// @param rate  the equations' right-hand side; a function of the state
/// @param first  rate(start)
template <std::size_t size, class StateAt, class Rate>
RungeKuttaStep<size> implicit_step(const StateAt& state_at, const Rate& rate, std::size_t speed,
                                   const std::array<double, size>& start,
                                   const std::array<double, size>& first, double h) {
    constexpr std::size_t stages = 5;
    constexpr double diagonal = 0.25, nan = std::numeric_limits<double>::quiet_NaN();
    constexpr std::array<std::array<double, stages - 1>, stages> weights{
        {{},
         {1.0 / 2.0},
         {17.0 / 50.0, -1.0 / 25.0},
         {371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0},
         {25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0}}};
    // Weights of order 4 minus those of order 3.
    constexpr std::array<double, stages> differences{25.0 / 24.0 - 59.0 / 48.0, -49.0 / 48.0 + 17.0 / 96.0,
                                                     125.0 / 16.0 - 225.0 / 32.0, 0.0, diagonal};
    std::array<std::array<double, size>, stages> slopes{};
    RungeKuttaStep<size> step{start, {}};
    const auto none = [&] {
        step.end.fill(nan);
        step.error.fill(nan);
        return step;
    };
    std::size_t on_jump = 0;
    for (std::size_t k = 0; k < stages; ++k) {
        std::array<double, size> known = start;
        for (std::size_t before = 0; before < k; ++before)
            for (std::size_t i = 0; i < size; ++i) known[i] += h * weights[k][before] * slopes[before][i];
        const auto stage = implicit_stage<size>(state_at, rate, speed, known, diagonal * h);
        if (!stage) return none();
        step.end = stage->state;
        slopes[k] = stage->slope;
        on_jump += stage->jumps ? 1 : 0;
        for (std::size_t i = 0; i < size; ++i) step.error[i] += h * differences[k] * slopes[k][i];
    }
    if (on_jump == 0 || on_jump == stages) return step;
    const auto whole = implicit_stage<size>(state_at, rate, speed, start, h);
    if (!whole) return none();
    step.end = whole->state;
    for (std::size_t i = 0; i < size; ++i) step.error[i] = h * (whole->slope[i] - first[i]);
    return step;
}

}  // namespace fidservo::plant
