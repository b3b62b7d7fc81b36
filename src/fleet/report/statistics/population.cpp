// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/population.h"

#include "core/demand.h"
#include "src/fleet/report/statistics/censored.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fidservo::fleet {
namespace {

Nodes over_mean(std::span<const Level> units, double spread) {
    std::vector<Point> points;
    for (const Level& unit : units) points.push_back({0.0, unit.value, unit.std, unit.limit});
    return over_level(points, spread * spread);
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
    for (const Level& unit : units)
        range = std::max(range, std::abs(unit.value - units.front().value) + unit.limit);
    if (units.size() < 2 || range == 0.0) return 0.0;
    const auto likelihood = [&](double spread) { return over_mean(units, spread).log_integral(); };
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
    const Moments mean = over_mean(units, spread).moments();
    return {mean.mean, std::sqrt(mean.variance), spread};
}

Level pooled(const Level& unit, const Population& population) {
    const double variance = unit.std * unit.std, all = variance + population.spread * population.spread;
    const double own = population.spread * population.spread / all;
    const Moments known =
        unit.named() ? Moments{unit.value, 0.0} : moments_within(unit.limit, population.mean, std::sqrt(all));
    const double drawn = (1.0 - own) * population.mean_std;
    return {own * known.mean + (1.0 - own) * population.mean,
            std::sqrt(own * variance + own * own * known.variance + drawn * drawn)};
}

}  // namespace fidservo::fleet
