// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/platform_swing.h"

#include "core/demand.h"

#include <cmath>
#include <numbers>

namespace fidservo::plant {

PlatformSwing make_platform_swing(const SwingParameters& parameters, double tick_s) {
    const double w = 2.0 * std::numbers::pi * parameters.frequency_Hz;
    const double zeta = parameters.damping_ratio;
    FIDSERVO_DEMAND(w > 0.0 && zeta >= 0.0 && zeta < 1.0);
    const double damped = w * std::sqrt(1.0 - zeta * zeta);
    const double envelope = std::exp(-zeta * w * tick_s);
    const double c = envelope * std::cos(damped * tick_s);
    const double s = envelope * std::sin(damped * tick_s) / damped;
    Eigen::Matrix2d decay;
    decay << c + zeta * w * s, s, -w * w * s, c - zeta * w * s;
    return {parameters, decay, parameters.gain / (w * w), 2.0 * zeta / w, tick_s};
}

void advance(const PlatformSwing& swing, SwingState& state, const Shaking& shaking) {
    const double held_mm_per_s = -swing.compliance_s2 * shaking.jerk_mm_per_s3;
    const auto held_mm = [&](double time_s) {
        return -swing.compliance_s2 * shaking.acceleration_mm_per_s2 +
               held_mm_per_s * (time_s - 0.5 * swing.tick_s - swing.lag_s);
    };
    const Eigen::Vector2d after = swing.decay * Eigen::Vector2d(state.position_mm - held_mm(0.0),
                                                                state.velocity_mm_per_s - held_mm_per_s);
    state = {held_mm(swing.tick_s) + after.x(), held_mm_per_s + after.y()};
}

}  // namespace fidservo::plant
