// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The image sensor: electrons, noise, grey levels.
#include "core/random.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fidservo::plant::view {

/// Fast unit normal numbers: xoshiro128+ (Blackman and Vigna 2018) in eight lanes. The four bytes of a draw
/// are added, and the sum, whose distribution is known, is mapped to the normal quantile at its middle. 1021
/// values up to 6.2 sigma, 0.007 sigma apart around zero; variance 1.
class NormalRow {
  public:
    NormalRow();
    /// Fills `normals` with independent draws. Seeds the lanes with 16 draws from the stream.
    void fill(NoiseStream& stream, std::span<float> normals) const;
    static constexpr int draws_from_stream = 16;

  private:
    static constexpr int sums = 4 * 255 + 1;
    std::array<float, sums> quantiles_;
};

/// Turns mean signals into grey levels:
///     grey = round(m + sqrt(m / g + r^2) z), clipped to 0..255;  m mean in grey levels,
///     g = full_well / 255 electrons a grey level, r read noise in grey levels, z unit normal.
/// The Poisson law of the shot noise is taken as normal: at the 1,000 electrons of ink its skewness is 0.03.
class Sensor {
  public:
    Sensor(double full_well_e, double read_noise_e);

    /// One row without noise.
    static void expose(std::span<const float> mean_grey, std::span<std::uint8_t> grey);
    /// One row with noise.
    void expose(std::span<const float> mean_grey, std::span<const float> normals,
                std::span<std::uint8_t> grey) const;

  private:
    float grey_per_e_;
    float read_variance_;  ///< grey levels squared
};

}  // namespace fidservo::plant::view
