// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/motion_blur.h"

#include "core/demand.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fidservo::plant::view {

namespace {

constexpr int neighbours = 8;

/// Weights of the samples at -3 .. 4 for the value at 0 <= x < 1.
std::array<double, neighbours> lagrange_weights(double x) {
    std::array<double, neighbours> weights{};
    for (int i = 0; i < neighbours; ++i) {
        weights[i] = 1.0;
        for (int j = 0; j < neighbours; ++j) {
            if (j != i) weights[i] *= (x - (j - 3)) / (i - j);
        }
    }
    return weights;
}

}  // namespace

double mean_position(std::span<const double> samples) {
    FIDSERVO_DEMAND(!samples.empty());
    if (samples.size() == 1) return samples.front();
    double sum = 0.0;
    for (const double sample : samples) sum += sample - samples.front();
    sum -= 0.5 * (samples.back() - samples.front());
    return samples.front() + sum / static_cast<double>(samples.size() - 1);
}

MotionKernel::MotionKernel(std::span<const double> shifts_px) {
    FIDSERVO_DEMAND(!shifts_px.empty());
    const auto [low, high] = std::minmax_element(shifts_px.begin(), shifts_px.end());
    if (*high - *low < invisible_motion_px) return;
    const auto largest_px = static_cast<int>(std::ceil(std::max(std::abs(*low), std::abs(*high))));
    reach_ = (largest_px + neighbours / 2 + 2) / 2 * 2;
    std::vector<double> taps(2 * static_cast<std::size_t>(reach_), 0.0);
    const auto intervals = static_cast<double>(shifts_px.size() - 1);
    for (std::size_t k = 0; k + 1 < shifts_px.size(); ++k) {
        const double step = shifts_px[k + 1] - shifts_px[k];
        const auto parts = static_cast<int>(std::ceil(2.0 * std::abs(step))) + 1;
        for (int part = 0; part < parts; ++part) {
            // The image shifted by +d shows at i what was at i - d.
            const double from = -(shifts_px[k] + step * (part + 0.5) / parts);
            const double whole = std::floor(from);
            const auto weights = lagrange_weights(from - whole);
            const int first = reach_ + static_cast<int>(whole) - 3;
            for (int i = 0; i < neighbours; ++i) taps[first + i] += weights[i] / (intervals * parts);
        }
    }
    taps_.assign(taps.begin(), taps.end());
}

void MotionKernel::apply(std::span<const float> sharp, std::span<float> blurred) const {
    FIDSERVO_DEMAND(sharp.size() == blurred.size() + 2 * static_cast<std::size_t>(reach_));
    std::fill(blurred.begin(), blurred.end(), 0.0F);
    float* const to = blurred.data();
    const std::size_t pixels = blurred.size();
    for (std::size_t k = 0; k < taps_.size(); k += 4) {
        const float* const tap = taps_.data() + k;
        const float* const from = sharp.data() + k;
        const float t0 = tap[0], t1 = tap[1], t2 = tap[2], t3 = tap[3];
        for (std::size_t i = 0; i < pixels; ++i) {
            to[i] += (t0 * from[i] + t1 * from[i + 1]) + (t2 * from[i + 2] + t3 * from[i + 3]);
        }
    }
}

}  // namespace fidservo::plant::view
