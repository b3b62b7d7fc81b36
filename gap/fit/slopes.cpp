// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/slopes.h"

namespace fidservo::gap {

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

}  // namespace fidservo::gap
