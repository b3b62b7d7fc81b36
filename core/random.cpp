// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/random.h"

#include <cmath>
#include <numbers>

namespace fidservo {

namespace {

/// SplitMix64's finaliser (Steele, Lea, Flood 2014): a bijection of 64 bits with full avalanche.
std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15u;

}  // namespace

NoiseStream::NoiseStream(std::uint64_t seed, std::string_view source) : key_(mix(seed + golden_gamma)) {
    for (const char letter : source) key_ = mix(key_ + golden_gamma + static_cast<unsigned char>(letter));
}

std::uint64_t NoiseStream::bits() {
    return mix(key_ + golden_gamma * ++position_);
}

double NoiseStream::uniform() {
    return static_cast<double>(bits() >> 11) * 0x1.0p-53;
}

double NoiseStream::normal() {
    const double radius = std::sqrt(-2.0 * std::log1p(-uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace fidservo
