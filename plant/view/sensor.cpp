// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/sensor.h"

#include "core/demand.h"
#include "plant/view/gaussian.h"

#include <algorithm>
#include <cmath>

namespace fidservo::plant::view {

namespace {

constexpr float white = 255.0F;

/// Nearest grey level: a level raised by one half and cut off. Ternaries on values, not std::clamp on
/// references nor std::lround: these become vector instructions.
std::uint8_t to_grey(float level) {
    constexpr float lowest = 0.5F, highest = white + 0.5F;
    const float raised = level + 0.5F;
    const float positive = raised > lowest ? raised : lowest;
    return static_cast<std::uint8_t>(static_cast<int>(positive < highest ? positive : highest));
}

/// Four numbers that the processor handles as one (a vector extension of g++ and clang).
constexpr int lanes = 4;
using Lanes = std::uint32_t __attribute__((vector_size(lanes * sizeof(std::uint32_t))));

/// Four independent random generators, one in each lane.
struct Generators {
    Lanes a{}, b{}, c{}, d{};

    explicit Generators(NoiseStream& stream) {
        for (Lanes* word : {&a, &b, &c, &d}) {
            for (int lane = 0; lane < lanes; lane += 2) {
                const std::uint64_t bits = stream.bits();
                (*word)[lane] = static_cast<std::uint32_t>(bits);
                (*word)[lane + 1] = static_cast<std::uint32_t>(bits >> 32);
            }
        }
    }

    Lanes draw() {
        const Lanes result = a + d;
        const Lanes shifted = b << 9;
        c ^= a;
        d ^= b;
        b ^= c;
        a ^= d;
        c ^= shifted;
        d = (d << 11) | (d >> 21);
        return result;
    }
};

Lanes sum_of_bytes(Lanes words) {
    const Lanes pairs = (words & 0x00ff00ffU) + ((words >> 8) & 0x00ff00ffU);
    return (pairs & 0xffffU) + (pairs >> 16);
}

/// Number of ways to make each sum of four bytes.
std::vector<double> ways_to_sum_four_bytes() {
    std::vector<double> ways = {1.0};
    for (int byte = 0; byte < 4; ++byte) {
        std::vector<double> next(ways.size() + 255, 0.0);
        for (std::size_t sum = 0; sum < ways.size(); ++sum) {
            for (int value = 0; value < 256; ++value) next[sum + value] += ways[sum];
        }
        ways = std::move(next);
    }
    return ways;
}

}  // namespace

NormalRow::NormalRow() : quantiles_{} {
    const std::vector<double> ways = ways_to_sum_four_bytes();
    FIDSERVO_DEMAND(ways.size() == sums);
    const double all = std::pow(256.0, 4);
    double below = 0.0, variance = 0.0;
    std::array<double, sums> quantiles{};
    for (int sum = 0; sum <= sums / 2; ++sum) {
        const double probability = ways[sum] / all;
        quantiles[sum] = sum == sums / 2 ? 0.0 : normal_quantile(below + 0.5 * probability);
        quantiles[sums - 1 - sum] = -quantiles[sum];
        below += probability;
        variance += 2.0 * probability * quantiles[sum] * quantiles[sum];
    }
    const double scale = 1.0 / std::sqrt(variance);
    for (int sum = 0; sum < sums; ++sum) quantiles_[sum] = static_cast<float>(quantiles[sum] * scale);
}

void NormalRow::fill(NoiseStream& stream, std::span<float> normals) const {
    Generators even(stream), odd(stream);  // two, so that one can work while the other waits
    constexpr int step = 2 * lanes;
    const auto draw = [&, this](float* to) {
        const Lanes first = sum_of_bytes(even.draw()), second = sum_of_bytes(odd.draw());
        for (int lane = 0; lane < lanes; ++lane) to[lane] = quantiles_[first[lane]];
        for (int lane = 0; lane < lanes; ++lane) to[lanes + lane] = quantiles_[second[lane]];
    };
    std::size_t i = 0;
    for (; i + step <= normals.size(); i += step) draw(normals.data() + i);
    std::array<float, step> rest{};
    draw(rest.data());
    std::copy_n(rest.begin(), normals.size() - i, normals.begin() + i);
}

Sensor::Sensor(double full_well_e, double read_noise_e)
    : grey_per_e_(static_cast<float>(white / full_well_e)),
      read_variance_(static_cast<float>(std::pow(read_noise_e * white / full_well_e, 2))) {}

void Sensor::expose(std::span<const float> mean_grey, std::span<std::uint8_t> grey) {
    const float* const mean = mean_grey.data();
    std::uint8_t* const result = grey.data();
    const std::size_t pixels = grey.size();
    for (std::size_t i = 0; i < pixels; ++i) result[i] = to_grey(mean[i]);
}

void Sensor::expose(std::span<const float> mean_grey, std::span<const float> normals,
                    std::span<std::uint8_t> grey) const {
    const float* const mean = mean_grey.data();
    const float* const normal = normals.data();
    std::uint8_t* const result = grey.data();
    const std::size_t pixels = grey.size();
    const float grey_per_e = grey_per_e_, read_variance = read_variance_;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float sigma = std::sqrt(mean[i] * grey_per_e + read_variance);
        result[i] = to_grey(mean[i] + sigma * normal[i]);
    }
}

}  // namespace fidservo::plant::view
