// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A counter-based generator for each noise source: draw k of a stream is a pure function of (seed, stream,
// k), so that the state is one number, and another source does not disturb the streams of the others.
#include <cstdint>
#include <string_view>

namespace fidservo {

/// A source of random numbers: the same from the same seed, on every machine.
class NoiseStream {
  public:
    /// @param source  name of the noise source, e.g. "hall"
    NoiseStream(std::uint64_t seed, std::string_view source);

    std::uint64_t bits();  ///< 64 random bits.
    double uniform();      ///< in [0, 1)
    double normal();       ///< mean 0, standard deviation 1

    /// How many numbers were drawn.
    std::uint64_t position() const { return position_; }
    /// Moves the stream to the state after that many draws.
    void seek(std::uint64_t position) { position_ = position; }

  private:
    std::uint64_t key_;
    std::uint64_t position_ = 0;
};

}  // namespace fidservo
