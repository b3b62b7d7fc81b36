// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>

namespace fidservo::reference {

/// One step of the classical Runge-Kutta method of order 4 for dx/dt = rate(x), over h_s seconds.
template <std::size_t n, class Rate>
std::array<double, n> runge_kutta_step(const std::array<double, n>& x, double h_s, const Rate& rate) {
    const auto along = [&x](const std::array<double, n>& slope, double way_s) {
        std::array<double, n> there = x;
        for (std::size_t i = 0; i < n; ++i) there[i] += way_s * slope[i];
        return there;
    };
    const std::array<double, n> k1 = rate(x);
    const std::array<double, n> k2 = rate(along(k1, 0.5 * h_s));
    const std::array<double, n> k3 = rate(along(k2, 0.5 * h_s));
    const std::array<double, n> k4 = rate(along(k3, h_s));
    std::array<double, n> next = x;
    for (std::size_t i = 0; i < n; ++i) next[i] += h_s / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    return next;
}

}  // namespace fidservo::reference
