// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step of the explicit Runge-Kutta pair of order 5 and 4 of Dormand and Prince, J. Comput. Appl. Math. 6
// (1980), Table 2.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fidservo::plant {

template <std::size_t size>
struct RungeKuttaStep {
    std::array<double, size> end;    ///< the solution of order 5
    std::array<double, size> error;  ///< the solution of order 5 minus that of order 4
};

/// One step of x' = rate(x), autonomous, over a duration h. `first` is rate(start).
template <std::size_t size, class Rate>
RungeKuttaStep<size> dormand_prince_step(const Rate& rate, const std::array<double, size>& start,
                                         const std::array<double, size>& first, double h) {
    using State = std::array<double, size>;
    const auto sum = [&](auto... terms) {
        State result = start;
        for (std::size_t i = 0; i < size; ++i) result[i] += h * (... + (terms.first * (*terms.second)[i]));
        return result;
    };
    const auto term = [](double weight, const State& slope) { return std::pair(weight, &slope); };
    const State& k1 = first;
    const State k2 = rate(sum(term(1.0 / 5.0, k1)));
    const State k3 = rate(sum(term(3.0 / 40.0, k1), term(9.0 / 40.0, k2)));
    const State k4 = rate(sum(term(44.0 / 45.0, k1), term(-56.0 / 15.0, k2), term(32.0 / 9.0, k3)));
    const State k5 = rate(sum(term(19372.0 / 6561.0, k1), term(-25360.0 / 2187.0, k2),
                              term(64448.0 / 6561.0, k3), term(-212.0 / 729.0, k4)));
    const State k6 = rate(sum(term(9017.0 / 3168.0, k1), term(-355.0 / 33.0, k2), term(46732.0 / 5247.0, k3),
                              term(49.0 / 176.0, k4), term(-5103.0 / 18656.0, k5)));
    const State end = sum(term(35.0 / 384.0, k1), term(500.0 / 1113.0, k3), term(125.0 / 192.0, k4),
                          term(-2187.0 / 6784.0, k5), term(11.0 / 84.0, k6));
    const State k7 = rate(end);
    State error;
    for (std::size_t i = 0; i < size; ++i)
        error[i] = h * (71.0 / 57600.0 * k1[i] - 71.0 / 16695.0 * k3[i] + 71.0 / 1920.0 * k4[i] -
                        17253.0 / 339200.0 * k5[i] + 22.0 / 525.0 * k6[i] - 1.0 / 40.0 * k7[i]);
    return {end, error};
}

/// The factor on the step size that would bring an error, given in units of the tolerance, within the
/// tolerance: 0.1 to 5.
inline double fitting_share(double error) {
    constexpr double safety = 0.9, most = 5.0, of_most = 1.8e-4;  // (safety / most)^5
    return error < of_most ? most : std::max(safety * std::pow(error, -0.2), 0.1);
}

}  // namespace fidservo::plant
