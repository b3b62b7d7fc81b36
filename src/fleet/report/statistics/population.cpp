// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/population.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>

namespace fidservo::fleet {
namespace {

struct WeightedMean {
    double mean, weights;
};

WeightedMean weighted_mean(std::span<const Level> units, double variance) {
    double weights = 0.0, values = 0.0;
    for (const Level& unit : units) {
        const double weight = 1.0 / (unit.std * unit.std + variance);
        weights += weight;
        values += weight * unit.value;
    }
    return {values / weights, weights};
}

double log_restricted_likelihood(std::span<const Level> units, double spread) {
    const WeightedMean mean = weighted_mean(units, spread * spread);
    double sum = std::log(mean.weights);
    for (const Level& unit : units) {
        const double variance = unit.std * unit.std + spread * spread;
        sum += std::log(variance) + (unit.value - mean.mean) * (unit.value - mean.mean) / variance;
    }
    return -0.5 * sum;
}

/// The largest of a function between two places, by golden sections.
template <class Function>
double largest_between(double low, double high, const Function& function) {
    constexpr double golden = 0.6180339887498949;
    constexpr int steps = 40;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = function(a), at_b = function(b);
    for (int step = 0; step < steps; ++step) {
        if (at_a > at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - golden * (high - low);
            at_a = function(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + golden * (high - low);
            at_b = function(b);
        }
    }
    return 0.5 * (low + high);
}

double likeliest_spread(std::span<const Level> units) {
    constexpr int steps = 40;
    double range = 0.0;
    for (const Level& unit : units) range = std::max(range, std::abs(unit.value - units.front().value));
    if (units.size() < 2 || range == 0.0) return 0.0;
    const auto likelihood = [&](double spread) { return log_restricted_likelihood(units, spread); };
    // A grid first: with few units the likelihood may have two maxima. Squares, as it is steep at nothing.
    const auto spread_at = [&](int k) { return 2.0 * range * k * k / (steps * steps); };
    int best = 0;
    double at_best = likelihood(0.0);
    for (int k = 1; k <= steps; ++k)
        if (const double here = likelihood(spread_at(k)); here > at_best) {
            best = k;
            at_best = here;
        }
    const double spread = largest_between(spread_at(std::max(0, best - 1)), spread_at(best + 1), likelihood);
    return likelihood(spread) > likelihood(0.0) ? spread : 0.0;
}

}  // namespace

Population population_of(std::span<const Level> units) {
    FIDSERVO_DEMAND(!units.empty());
    for (const Level& unit : units) FIDSERVO_DEMAND(unit.std > 0.0);
    const double spread = likeliest_spread(units);
    const WeightedMean mean = weighted_mean(units, spread * spread);
    return {mean.mean, 1.0 / std::sqrt(mean.weights), spread};
}

Level pooled(const Level& unit, const Population& population) {
    const double own =
        population.spread * population.spread / (population.spread * population.spread + unit.std * unit.std);
    const double variance =
        own * unit.std * unit.std + (1.0 - own) * (1.0 - own) * population.mean_std * population.mean_std;
    return {own * unit.value + (1.0 - own) * population.mean, std::sqrt(variance)};
}

}  // namespace fidservo::fleet
