// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Integrals of log-concave functions of one variable.
#include "src/fleet/report/statistics/log_of_sum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fidservo::fleet {

/// Distance of nodes relative to the least standard deviation that the function may have as a density. The
/// sum's relative error is then 4e-14.
inline constexpr double step_of_std = 0.8;

/// A mean and a variance.
struct Moments {
    double mean = 0.0, variance = 0.0;
};

/// A function of one variable at equidistant nodes: logarithms of value times distance.
struct Nodes {
    std::vector<double> places, log_weights;

    /// log of the integral.
    double log_integral() const { return log_of_sum(log_weights); }

    /// Mean and variance, with the function as an unnormalised density.
    Moments moments() const {
        const double all = log_integral();
        double mean = 0.0, squares = 0.0;
        for (std::size_t k = 0; k < places.size(); ++k) mean += std::exp(log_weights[k] - all) * places[k];
        for (std::size_t k = 0; k < places.size(); ++k)
            squares += std::exp(log_weights[k] - all) * (places[k] - mean) * (places[k] - mean);
        return {mean, squares};
    }
};

/// Places nodes from a start in both directions until the function is negligible. The sum over them is the
/// integral to a relative error of about exp(-2 pi^2 / (step / std)^2) of it. Source: Trefethen, Weideman,
/// SIAM Review 56, 2014.
/// @param log_of  the logarithm of a log-concave function
/// @param step  at most the least standard deviation that the function may have as a density
template <class LogFunction>
Nodes nodes_of(double start, double step, const LogFunction& log_of) {
    constexpr double nothing = 30.0;  // below the maximum: exp(-30) is 1e-13
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
