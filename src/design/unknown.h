// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How much an experiment teaches of what no named effect explains and no equation describes.
#include "gap/diagnosis.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fidservo::design {

/// What an unexplained error may be a function of, as far as commands can change it.
enum class Quantity : std::uint8_t { velocity, position, macro_command, temperature, contraction };

struct Unknown {
    std::vector<Quantity> depends_on;
    double excess = 0.0;  ///< mean square of what is left of the worst signal, over the floor's, less 1
};

/// What depends on none of these is taken to depend on what moves in the accused block. Nothing where less
/// is left than what a diagnosis calls a remainder (1.25 floors).
std::optional<Unknown> unknown_of(const gap::Diagnosis& diagnosis);

/// Information that a recording brings of any function of the quantities: each one's range on the rig in
/// twelve bins, a value for each bin that is expected to be as large as what is left, a window of 1 s an
/// observation of it,
///     I = 1/2 sum over bins of log(1 + excess t_b / 1 s),     t_b the time spent in the bin.
/// It is largest where all bins are visited alike. Of several quantities the least counts.
/// @param evidence  of the one recording
double information(const Unknown& unknown, const gap::Evidence& evidence);

}  // namespace fidservo::design
