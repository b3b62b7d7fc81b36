// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/slopes.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {
namespace {

/// For each parameter of another hypothesis, its index among the fitted parameters, or none where its
/// effect is not fitted. Empty if the other hypothesis lacks a fitted parameter, or has it in another
/// scale, or only one of the two has a derivative with respect to it.
std::optional<std::vector<std::optional<std::size_t>>> places_in(const ScaledParameters& fitted,
                                                                 const ScaledParameters& others) {
    std::vector<std::optional<std::size_t>> places(others.size());
    const auto is_same = [&](std::size_t own, std::size_t other) {
        return !places[other] && fitted.is_same(own, others, other) &&
               fitted.scale(own) == others.scale(other) && fitted.is_level(own) == others.is_level(other);
    };
    for (std::size_t own = 0; own < fitted.size(); ++own) {
        std::size_t other = 0;
        while (other < others.size() && !is_same(own, other)) ++other;
        if (other == others.size()) return {};
        places[other] = own;
    }
    return places;
}

}  // namespace

Errors slope(const Predict& predict, const ScaledParameters& parameters, std::size_t k, const Errors& errors,
             double step_scales) {
    if (parameters.is_level(k)) return Errors(errors.size(), 0.0F);
    std::vector<double> beside = parameters.values;
    const double step = beside[k] + step_scales <= parameters.high(k) ? step_scales : -step_scales;
    beside[k] += step;
    Errors change = predict(parameters.at(beside));
    if (change.empty()) change = errors;
    for (std::size_t i = 0; i < change.size(); ++i)
        change[i] = (change[i] - errors[i]) / static_cast<float>(step);
    return change;
}

std::optional<std::vector<Errors>> updated_slopes(const KnownSlopes& nearby,
                                                  const ScaledParameters& parameters, const Errors& errors,
                                                  std::span<const Window> windows,
                                                  std::span<const std::size_t> counted) {
    constexpr double well = 0.1;  // share of the change's sum of squares that may be mispredicted
    // Mispredictions up to four times the rounding of errors are no reason for an update, in which they
    // would be divided by a step that may be tiny.
    constexpr double most_rounding = 16.0;
    if (nearby.by_parameter.empty() || nearby.errors.empty()) return {};
    const ScaledParameters there(nearby.at);
    const auto places = places_in(parameters, there);
    if (!places) return {};
    std::vector<float> step(there.size());
    double way = 0.0;
    for (std::size_t k = 0; k < step.size(); ++k) {
        const std::optional<std::size_t> own = (*places)[k];
        step[k] = static_cast<float>((own ? parameters.values[*own] : there.vanishing(k)) - there.values[k]);
        way += static_cast<double>(step[k]) * step[k];
    }
    Errors missed(errors.size(), 0.0F);
    double missed_squares = 0.0, changed_squares = 0.0, rounding_squares = 0.0;
    for (const std::size_t w : counted)
        for (std::size_t row = windows[w].begin; row < windows[w].end; ++row) {
            const float change = errors[row] - nearby.errors[row];
            float expected = 0.0F;
            for (std::size_t k = 0; k < step.size(); ++k)
                if (std::isfinite(nearby.by_parameter[k][row]))
                    expected += nearby.by_parameter[k][row] * step[k];
            if (!std::isfinite(change)) continue;
            missed[row] = change - expected;
            missed_squares += static_cast<double>(missed[row]) * missed[row];
            changed_squares += static_cast<double>(change) * change;
            const double rounding =
                std::numeric_limits<float>::epsilon() * std::max(std::abs(errors[row]), 1.0F);
            rounding_squares += rounding * rounding;
        }
    const bool is_rounding = missed_squares <= most_rounding * rounding_squares;
    if (!is_rounding && missed_squares > well * changed_squares) return {};
    std::vector<Errors> slopes(parameters.size());
    parallel_for(step.size(), [&](std::size_t k) {
        const std::optional<std::size_t> own = (*places)[k];
        if (!own) return;
        slopes[*own] = nearby.by_parameter[k];
        if (is_rounding || !(way > 0.0)) return;
        const float share = step[k] / static_cast<float>(way);
        for (const std::size_t w : counted)
            for (std::size_t row = windows[w].begin; row < windows[w].end; ++row)
                slopes[*own][row] += share * missed[row];
    });
    return slopes;
}

}  // namespace fidservo::gap
