// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/reproduce/step_response.h"

#include "core/demand.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::reproduce {

StepResponse step_response(std::span<const double> position, double from, double to, double band,
                           double tail_s, double tick_s) {
    FIDSERVO_DEMAND(!position.empty() && band > 0.0 && tail_s > 0.0);
    StepResponse response{.from = from, .to = to};
    const double side = to >= from ? 1.0 : -1.0;
    const auto seconds_of = [&](auto place) {
        return tick_s * static_cast<double>(place - position.begin());
    };

    const auto outside = [&](double at) { return std::abs(at - to) > band; };
    const auto last_outside = std::find_if(position.rbegin(), position.rend(), outside);
    response.settling_s = last_outside == position.rbegin() ? std::numeric_limits<double>::infinity()
                                                            : seconds_of(last_outside.base());
    response.dead_s = seconds_of(
        std::ranges::find_if(position, [&](double at) { return std::abs(at - position.front()) > band; }));
    for (const double at : position) response.overshoot = std::max(response.overshoot, side * (at - to));

    const auto rows =
        std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(tail_s / tick_s)), 1, position.size());
    const auto tail = position.last(rows);
    double squares = 0.0;
    for (const double at : tail) {
        response.final_error += (at - to) / static_cast<double>(rows);
        squares += (at - to) * (at - to);
    }
    response.tail_rms = std::sqrt(squares / static_cast<double>(rows));
    const auto [low, high] = std::ranges::minmax(tail);
    response.tail_peak_to_peak = high - low;
    return response;
}

std::vector<HeldSetpoint> held_setpoints(std::span<const double> setpoint) {
    std::vector<HeldSetpoint> held;
    for (std::size_t k = 0; k < setpoint.size(); ++k) {
        if (std::isnan(setpoint[k])) continue;
        if (!held.empty() && held.back().end == k && held.back().value == setpoint[k])
            held.back().end = k + 1;
        else
            held.push_back({k, k + 1, setpoint[k]});
    }
    return held;
}

}  // namespace fidservo::reproduce
