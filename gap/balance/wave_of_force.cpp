// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/wave_of_force.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Dense>

namespace fidservo::gap {

WaveOfForce strongest_wave(const CarriageForces& forces,
                           const std::function<double(const SlidingRow&)>& quantity,
                           const std::function<double(const SlidingRow&)>& factor_V, double shortest,
                           double longest) {
    constexpr double steps_in_a_turn = 2.0;  // of a wave's phase over the whole span
    const std::vector<float> values = forces.values(quantity);
    if (values.empty()) return {};
    const auto [low, high] = std::ranges::minmax(values);
    const double span = static_cast<double>(high) - static_cast<double>(low);
    if (span < 2.0 * shortest) return {};
    double squares = 0.0;
    const auto weight = [](double lacking) { return 1.0 / (1.0 + lacking * lacking); };
    for (const double lacking : forces.lacking()) {
        squares += weight(lacking) * lacking * lacking;
    }
    const double lowest = 1.0 / std::min(longest, span), step = 1.0 / (steps_in_a_turn * span);
    std::vector<WaveOfForce> waves(1 + static_cast<std::size_t>((1.0 / shortest - lowest) / step));
    parallel_for(waves.size(), [&](std::size_t k) {
        const double frequency = lowest + static_cast<double>(k) * step;
        const auto column = [&](double phase) {
            return forces.of_force(0, [&](const SlidingRow& at) {
                return factor_V(at) * std::sin(2.0 * std::numbers::pi * frequency * quantity(at) + phase);
            });
        };
        const Column sine = column(0.0), cosine = column(0.5 * std::numbers::pi);
        Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
        Eigen::Vector2d right = Eigen::Vector2d::Zero();
        for (std::size_t support = 0; support < forces.supports().size(); ++support) {
            const double lacking = forces.lacking()[support];
            const Eigen::Vector2d row(sine.values[support], cosine.values[support]);
            normal += weight(lacking) * row * row.transpose();
            right += weight(lacking) * lacking * row;
        }
        waves[k] = {1.0 / frequency,
                    right.dot(normal.completeOrthogonalDecomposition().solve(right)) / squares};
    });
    return *std::ranges::max_element(waves, {}, &WaveOfForce::share);
}

}  // namespace fidservo::gap
