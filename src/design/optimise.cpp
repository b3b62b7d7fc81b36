// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/design/optimise.h"

#include "core/demand.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <type_traits>

#include <nlopt.h>

namespace fidservo::design {
namespace {

struct Destroy {
    void operator()(nlopt_opt optimiser) const { nlopt_destroy(optimiser); }
};
using Optimiser = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, Destroy>;

/// The function, the best point that it was asked for, and what it has thrown.
struct Asked {
    const std::function<double(const std::vector<double>&)>& function;
    Optimum best;
    nlopt_opt optimiser = nullptr;
    std::exception_ptr thrown = nullptr;
};

/// No exception may pass through NLopt.
double ask(unsigned size, const double* x, double*, void* data) {
    auto& asked = *static_cast<Asked*>(data);
    constexpr double worst = -1e300;
    if (asked.thrown) return worst;
    try {
        const std::vector<double> at(x, x + size);
        const double value = asked.function(at);
        if (value > asked.best.value) asked.best = {at, value};
        return value;
    } catch (...) {
        asked.thrown = std::current_exception();
        nlopt_force_stop(asked.optimiser);
        return worst;
    }
}

void run(nlopt_algorithm algorithm, int evaluations, Asked& asked) {
    if (evaluations <= 0) return;
    constexpr double first_step = 0.08;
    std::vector<double> x = asked.best.at;
    const auto size = static_cast<unsigned>(x.size());
    const Optimiser optimiser(nlopt_create(algorithm, size));
    FIDSERVO_DEMAND(optimiser != nullptr);
    asked.optimiser = optimiser.get();
    const unsigned population = std::max(size + 1, static_cast<unsigned>(evaluations) / 2);
    bool is_set = nlopt_set_max_objective(optimiser.get(), ask, &asked) > 0;
    is_set = nlopt_set_lower_bounds1(optimiser.get(), 0.0) > 0 && is_set;
    is_set = nlopt_set_upper_bounds1(optimiser.get(), 1.0) > 0 && is_set;
    is_set = nlopt_set_maxeval(optimiser.get(), evaluations) > 0 && is_set;
    is_set = nlopt_set_population(optimiser.get(), population) > 0 && is_set;
    is_set = nlopt_set_initial_step1(optimiser.get(), first_step) > 0 && is_set;
    FIDSERVO_DEMAND(is_set);
    double value = 0.0;
    (void)nlopt_optimize(optimiser.get(), x.data(), &value);  // the best point is kept by `ask`
    if (asked.thrown) std::rethrow_exception(asked.thrown);
}

}  // namespace

Optimum maximised(const std::function<double(const std::vector<double>&)>& function,
                  std::vector<double> start, double value, const OptimiserEffort& effort) {
    constexpr unsigned long seed = 1;
    nlopt_srand(seed);
    Asked asked{function, {std::move(start), value}};
    run(NLOPT_GN_CRS2_LM, effort.global, asked);
    run(NLOPT_LN_SBPLX, effort.local, asked);
    return asked.best;
}

}  // namespace fidservo::design
