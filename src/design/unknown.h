// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The information that an experiment gives about errors that neither a named effect nor an equation explains.
#include "gap/diagnosis.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fidservo::design {

/// Quantities on which an unexplained error may depend, as far as commands can change them.
enum class Quantity : std::uint8_t { velocity, position, macro_command, temperature, contraction };

struct Unknown {
    std::vector<Quantity> depends_on;
    /// Mean square of the worst signal's remaining errors over that of the floor, minus 1.
    double excess = 0.0;
};

/// The unexplained remainder of a diagnosis. If it depends on none of these quantities, it is assumed to
/// depend on what moves in the accused block. Empty where less remains than a diagnosis calls a remainder
/// (1.25 floors).
std::optional<Unknown> unknown_of(const gap::Diagnosis& diagnosis);

/// Expected information, nats, of a recording on an unknown function of a quantity: the quantity's range on
/// the rig is divided into twelve bins; the function has an independent value in each, with a variance of
/// `excess`, and a window of 1 s is one observation of it with the variance 1, so that
///     I = 1/2 sum over bins of log(1 + excess t_b / 1 s),     t_b the time spent in the bin.
/// It is largest if the same time is spent in all bins. If there are several quantities, the smallest value
/// is returned.
/// @param evidence  of this recording alone
double information(const Unknown& unknown, const gap::Evidence& evidence);

}  // namespace fidservo::design
