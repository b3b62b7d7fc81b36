// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/slopes.h"

#include "core/parallel.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {
Errors slope(const Predict& predict, const ScaledParameters& parameters, std::size_t k, const Errors& errors,
             double step_scales) {
    if (parameters.is_level(k)) return Errors(errors.size(), 0.0F);
    std::vector<double> beside = parameters.values;
    const double length = parameters.moves_carriage(k) ? step_scales : std::min(step_scales, smooth_step);
    const double step = beside[k] + length <= parameters.high(k) ? length : -length;
    beside[k] += step;
    Errors change = predict(parameters.at(beside));
    if (change.empty()) change = errors;
    for (std::size_t i = 0; i < change.size(); ++i)
        change[i] = (change[i] - errors[i]) / static_cast<float>(step);
    return change;
}

bool move_slopes(KnownSlopes& known, std::span<const double> values, const Errors& errors) {
    constexpr double well = small_part;  // share of the change's sum of squares that may be mispredicted
    // Mispredictions up to four times the rounding of errors are no reason for an update, in which they
    // would be divided by a step that may be tiny.
    constexpr double most_rounding = 16.0;
    std::vector<float> step(values.size());
    double way = 0.0;
    for (std::size_t k = 0; k < step.size(); ++k) {
        step[k] = static_cast<float>(values[k] - known.values[k]);
        way += static_cast<double>(step[k]) * step[k];
    }
    if (!(way > 0.0)) return false;
    Errors missed(errors.size(), 0.0F);
    double missed_squares = 0.0, changed_squares = 0.0, rounding_squares = 0.0;
    for (std::size_t row = 0; row < errors.size(); ++row) {
        const float change = errors[row] - known.errors[row];
        float expected = 0.0F;
        for (std::size_t k = 0; k < step.size(); ++k)
            if (std::isfinite(known.by_parameter[k][row])) expected += known.by_parameter[k][row] * step[k];
        if (!std::isfinite(change)) continue;
        missed[row] = change - expected;
        missed_squares += static_cast<double>(missed[row]) * missed[row];
        changed_squares += static_cast<double>(change) * change;
        const double rounding = std::numeric_limits<float>::epsilon() * std::max(std::abs(errors[row]), 1.0F);
        rounding_squares += rounding * rounding;
    }
    if (missed_squares > most_rounding * rounding_squares) {
        if (missed_squares > well * changed_squares) return false;
        parallel_for(step.size(), [&](std::size_t k) {
            const float share = step[k] / static_cast<float>(way);
            for (std::size_t row = 0; row < missed.size(); ++row)
                known.by_parameter[k][row] += share * missed[row];
        });
    }
    known.values.assign(values.begin(), values.end());
    known.errors = errors;
    return true;
}

}  // namespace fidservo::gap
