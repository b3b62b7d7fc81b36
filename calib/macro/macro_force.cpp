// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_force.h"

#include "calib/macro/macro_recordings.h"
#include "calib/significance.h"
#include "core/failure.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

namespace {

constexpr double bell_std_s = 0.005;

/// Weights of a normal law, out to four standard deviations.
std::vector<double> bell(double tick_s) {
    const auto reach = static_cast<int>(std::ceil(4.0 * bell_std_s / tick_s));
    std::vector<double> weights;
    weights.reserve(2 * static_cast<std::size_t>(reach) + 1);
    double sum = 0.0;
    for (int i = -reach; i <= reach; ++i) {
        weights.push_back(std::exp(-0.5 * std::pow(i * tick_s / bell_std_s, 2)));
        sum += weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Where the bell reaches no end of the values; value i of the answer belongs to tick i + (bell size) / 2.
std::vector<double> smoothed(const std::vector<double>& values, const std::vector<double>& weights) {
    std::vector<double> result;
    if (values.size() < weights.size()) return result;
    result.reserve(values.size() - weights.size() + 1);
    for (std::size_t k = 0; k + weights.size() <= values.size(); ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * values[k + i];
        result.push_back(sum);
    }
    return result;
}

/// What white noise of unit variance in the readings makes of  tau a + v.
struct NoiseOfForce {
    double variance;    ///< the filter's squared weights
    double correlated;  ///< values that say as much of their variance as one that is independent
};

NoiseOfForce noise_of_force(double tick_s, double time_constant_s) {
    std::vector<double> weights = bell(tick_s);
    weights.insert(weights.begin(), 2, 0.0);
    weights.insert(weights.end(), 2, 0.0);
    std::vector<double> response;
    for (std::size_t i = 1; i + 1 < weights.size(); ++i) {
        const double speed = (weights[i + 1] - weights[i - 1]) / (2.0 * tick_s);
        const double acceleration = (weights[i + 1] - 2.0 * weights[i] + weights[i - 1]) / (tick_s * tick_s);
        response.push_back(time_constant_s * acceleration + speed);
    }
    NoiseOfForce noise{0.0, 1.0};
    for (const double weight : response) noise.variance += weight * weight;
    for (std::size_t lag = 1; lag < response.size(); ++lag) {
        double together = 0.0;
        for (std::size_t i = lag; i < response.size(); ++i) together += response[i] * response[i - lag];
        noise.correlated += 2.0 * std::pow(together / noise.variance, 2);
    }
    return noise;
}

struct ForceSample {
    double speed_mm_per_s;
    double drive_mm_per_s;
    double error_mm_per_s;
};

void append_samples(std::vector<ForceSample>& samples, const MacroTrace& trace, const MacroMotion& motion) {
    const std::vector<double> weights = bell(trace.tick_s);
    const std::vector<double> place_mm = smoothed(trace.position_mm, weights);
    if (place_mm.size() < 3) return;
    // Between ticks k and k + 1 the command k is in force: the drive at tick k is the mean of both sides.
    const std::size_t half = weights.size() / 2;
    std::vector<double> drive(trace.position_mm.size()), friction(trace.position_mm.size());
    for (std::size_t k = 1; k + 1 < drive.size(); ++k) {
        drive[k] = 0.5 * (drive_speed_mm_per_s(motion, trace.command_V[k - 1]) +
                          drive_speed_mm_per_s(motion, trace.command_V[k]));
        const std::size_t i = std::clamp<std::size_t>(k, half + 1, half + place_mm.size() - 2) - half;
        friction[k] = std::copysign(motion.friction_mm_per_s, place_mm[i + 1] - place_mm[i - 1]);
    }
    const std::vector<double> smooth_drive = smoothed(drive, weights);
    const std::vector<double> smooth_friction = smoothed(friction, weights);
    const double tick_s = trace.tick_s;
    for (std::size_t i = 1; i + 1 < place_mm.size(); ++i) {
        const double speed = (place_mm[i + 1] - place_mm[i - 1]) / (2.0 * tick_s);
        const double acceleration =
            (place_mm[i + 1] - 2.0 * place_mm[i] + place_mm[i - 1]) / (tick_s * tick_s);
        samples.push_back(
            {speed, smooth_drive[i],
             smooth_drive[i] - smooth_friction[i] - motion.time_constant_s * acceleration - speed});
    }
}

}  // namespace

Result<double> relative_force_error(std::span<const MacroTrace> traces, const MacroMotion& motion,
                                    double white_noise_mm) {
    constexpr double slowest_share = 0.05, least_s = 0.1;
    std::vector<ForceSample> samples;
    for (const MacroTrace& trace : traces) append_samples(samples, trace, motion);
    double fastest = 0.0;
    for (const ForceSample& sample : samples) fastest = std::max(fastest, std::abs(sample.speed_mm_per_s));
    double errors = 0.0, drives = 0.0, used = 0.0;
    for (const ForceSample& sample : samples) {
        if (std::abs(sample.speed_mm_per_s) <= slowest_share * fastest) continue;
        errors += sample.error_mm_per_s * sample.error_mm_per_s;
        drives += sample.drive_mm_per_s * sample.drive_mm_per_s;
        ++used;
    }
    if (traces.empty() || used * traces.front().tick_s < least_s || drives == 0.0)
        return failure(Reason::not_identifiable, "less than 100 ms of motion to judge the force by");
    constexpr double level = 0.01;
    const NoiseOfForce of_noise = noise_of_force(traces.front().tick_s, motion.time_constant_s);
    const double noise = used * std::pow(white_noise_mm, 2) * of_noise.variance;
    const double by_chance =
        mean_square_ratio_bound(used / of_noise.correlated, used / third_differences_correlated, level);
    return std::sqrt(std::max(0.0, errors - by_chance * noise) / drives);
}

}  // namespace fidservo::calib
