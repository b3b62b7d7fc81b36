// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The largest value of a function in a box, without derivatives.
#include <functional>
#include <vector>

namespace fidservo::design {

struct OptimiserEffort {
    int global = 0, local = 0;  ///< how often the function may be asked in each part
};

struct Optimum {
    std::vector<double> at;
    double value;
};

/// Controlled random search with local mutation (Kaelo and Ali, J. Optim. Theory Appl. 130, 2006), the start
/// among its population, then subplex (Rowan, 1990) from the best point; both of NLopt. Deterministic. What
/// the function throws ends the search and is thrown again.
/// @param start  in the box 0 to 1 in each coordinate; never is the result worse
/// @param value  of the function there
Optimum maximised(const std::function<double(const std::vector<double>&)>& function,
                  std::vector<double> start, double value, const OptimiserEffort& effort);

}  // namespace fidservo::design
