// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Arithmetic on eight numbers at a time: vector instructions where the processor has them, scalar ones
// elsewhere.
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace fidservo::vision {

inline constexpr std::size_t lane_count = 8;
using Lanes [[gnu::vector_size(lane_count * sizeof(float))]] = float;
using LaneBits [[gnu::vector_size(lane_count * sizeof(float))]] = std::int32_t;

// Arguments and results are passed by reference, as the calling convention for vectors depends on the
// processor.

[[gnu::always_inline]] inline void load(const float* from, Lanes& into) {
    std::memcpy(&into, from, sizeof into);
}

[[gnu::always_inline]] inline void store(const Lanes& from, float* into) {
    std::memcpy(into, &from, sizeof from);
}

[[gnu::always_inline]] inline float sum_of(const Lanes& lanes) {
    float sum = 0.0F;
    for (std::size_t k = 0; k < lane_count; ++k) sum += lanes[k];
    return sum;
}

/// exp(x) for x <= 0, to 3e-7 relative; clamped at x = -80.
[[gnu::always_inline]] inline void exp_of_negative(const Lanes& x, Lanes& result) {
    constexpr float log2_e = 1.44269504F;
    constexpr float lowest = -80.0F;
    constexpr int exponent_bias = 127, mantissa_bits = 23;
    const Lanes t = (x < lowest ? x * 0.0F + lowest : x) * log2_e;
    const LaneBits whole = __builtin_convertvector(t - 0.5F, LaneBits);
    const Lanes f = t - __builtin_convertvector(whole, Lanes);
    const LaneBits power_bits = (whole + exponent_bias) << mantissa_bits;
    Lanes power;
    std::memcpy(&power, &power_bits, sizeof power);
    result = power *
             (1.0F + f * (0.69314718F +
                          f * (0.24022651F +
                               f * (0.05550411F + f * (0.00961813F + f * (0.00133336F + f * 0.00015404F))))));
}

/// 1 / sqrt(x) for x > 0, to 5e-6 relative: Newton's method, started from the halved exponent.
[[gnu::always_inline]] inline void inverse_root(const Lanes& x, Lanes& result) {
    constexpr std::int32_t start = 0x5f375a86;  // Lomont, Fast inverse square root, 2003
    LaneBits bits;
    std::memcpy(&bits, &x, sizeof bits);
    bits = start - (bits >> 1);
    std::memcpy(&result, &bits, sizeof result);
    for (int step = 0; step < 2; ++step) result *= 1.5F - 0.5F * x * result * result;
}

}  // namespace fidservo::vision
