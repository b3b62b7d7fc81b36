// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/preisach_shift.h"

#include "core/failure.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace fidservo::calib {

namespace {

constexpr int coarse_steps = 100;  ///< over the range searched, half the table's to either side

double rms_at(const PreisachFit& model, HysteresisTrace& moved, const HysteresisTrace& trace, double shift) {
    for (std::size_t k = 0; k < trace.input.size(); ++k) moved.input[k] = trace.input[k] - shift;
    return prediction_rms(model, moved);
}

}  // namespace

Result<TemperatureShift> fit_temperature_shift(const PreisachFit& model, const HysteresisTrace& trace) {
    if (const Status checked = check_hysteresis_trace(trace, model.table.nodes()); !checked)
        return tl::make_unexpected(checked.error());
    HysteresisTrace moved = trace;
    const auto rms = [&](double shift) { return rms_at(model, moved, trace, shift); };
    const double largest = 0.5 * (model.table.high_degC() - model.table.low_degC());
    const double step = 2.0 * largest / coarse_steps;
    double best = 0.0, least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= coarse_steps; ++i) {
        const double shift = -largest + step * i, here = rms(shift);
        if (here < least) best = shift, least = here;
    }
    if (std::abs(best) > largest - 0.5 * step)
        return failure(Reason::not_identifiable,
                       "no shift within half the table's range fits the second loop");

    double low = best - step, high = best + step;
    const double shrink = 1.0 / std::numbers::phi;
    while (high - low > 1e-6 * largest) {
        const double left = high - shrink * (high - low), right = low + shrink * (high - low);
        rms(left) < rms(right) ? high = right : low = left;
    }
    const double shift = 0.5 * (low + high);
    const std::vector<double> at = [&] {
        rms(shift);
        return predict(model, moved.input);
    }();
    const double slight = 0.1 * step;
    rms(shift + slight);
    const std::vector<double> beside = predict(model, moved.input);
    std::vector<double> residual(at.size());
    double information = 0.0;
    for (std::size_t k = 0; k < at.size(); ++k) {
        residual[k] = trace.output[k] - at[k];
        information += std::pow((beside[k] - at[k]) / slight, 2);
    }
    const double error = rms(shift);
    return TemperatureShift{shift, error * std::sqrt(correlation_length(residual) / information), error,
                            rms(0.0)};
}

}  // namespace fidservo::calib
