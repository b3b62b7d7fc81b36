// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Integrals of log-concave functions of one variable.
#include "src/fleet/report/statistics/log_of_sum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fidservo::fleet {

/// Between nodes, of the least std that a law may have: the sum's error is then 4e-14.
inline constexpr double step_of_std = 0.8;

/// A mean and a variance.
struct Moments {
    double mean = 0.0, variance = 0.0;
};

/// A function of one variable at places that are equally distant: logarithms of value times distance.
struct Nodes {
    std::vector<double> places, log_weights;

    /// log of the integral.
    double log_integral() const { return log_of_sum(log_weights); }

    /// Of the variable, the function being its density but for a factor.
    Moments moments() const {
        const double all = log_integral();
        double mean = 0.0, squares = 0.0;
        for (std::size_t k = 0; k < places.size(); ++k) mean += std::exp(log_weights[k] - all) * places[k];
        for (std::size_t k = 0; k < places.size(); ++k)
            squares += std::exp(log_weights[k] - all) * (places[k] - mean) * (places[k] - mean);
        return {mean, squares};
    }
};

/// Nodes from a place on in both directions until nothing is left. The sum over them is the integral but for
/// a part of about exp(-2 pi^2 / (step / std)^2) of it. Source: Trefethen, Weideman, SIAM Review 56, 2014.
/// @param log_of  the logarithm of a log-concave function
/// @param step  the least std that the function may have, as a density, or less
template <class LogFunction>
Nodes nodes_of(double start, double step, const LogFunction& log_of) {
    constexpr double nothing = 30.0;  // below the largest: exp(-30) is 1e-13
    constexpr int most = 4000;
    const double log_step = std::log(step), first = log_of(start);
    Nodes nodes{{start}, {first + log_step}};
    double largest = first;
    for (const double direction : {step, -step}) {
        double before = first;
        for (int k = 1; k < most; ++k) {
            const double place = start + k * direction, here = log_of(place);
            nodes.places.push_back(place);
            nodes.log_weights.push_back(here + log_step);
            largest = std::max(largest, here);
            if (here < largest - nothing && here < before) break;
            before = here;
        }
    }
    return nodes;
}

}  // namespace fidservo::fleet
