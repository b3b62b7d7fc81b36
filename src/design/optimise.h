// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The largest value of a function in a box, without derivatives.
#include <functional>
#include <vector>

namespace fidservo::design {

struct OptimiserEffort {
    int global = 0, local = 0;  ///< number of evaluations of the function in each part
};

struct Optimum {
    std::vector<double> at;
    double value;
};

/// Controlled random search with local mutation (Kaelo and Ali, J. Optim. Theory Appl. 130, 2006), with the
/// start in its population, then subplex (Rowan, 1990) from the best point; both from NLopt. Deterministic.
/// An exception of the function ends the search and is passed on.
/// @param start  a point of the unit box; the result is never worse than it
/// @param value  the function's value at the start
Optimum maximised(const std::function<double(const std::vector<double>&)>& function,
                  std::vector<double> start, double value, const OptimiserEffort& effort);

}  // namespace fidservo::design
