// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The gap that a cause makes when it is the only one in a rig, and the size at which it makes a given gap.
#include "src/selfcheck/draw/true_rig.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace fidservo::selfcheck {

/// The excess of a rig's gap over the floor, sqrt(gap^2 - 1), with the gap in floors over all signals, when
/// the nominal rig predicts a campaign of this rig. For the nominal rig itself it is about 0.1, by chance.
double gap_alone(const Rig& nominal, const TrueRig& rig, std::uint64_t campaign_seed);

/// A gap to be reached, in floors.
struct GapAim {
    double low, high;  ///< the allowed range
    double target;     ///< target within the range
};

/// The range of a cause's size, in its unit.
struct SizeRange {
    double start;    ///< where the search begins
    double largest;  ///< largest size; beyond it a rig would count as broken
};

struct SizedGap {
    double size, gap_floors;
};

/// Finds a size whose gap is in the allowed range and, unless the gap is discontinuous there, within a half
/// of the target: first by proportion, then by bisection of the logarithm of the size. Empty if the largest
/// size makes too small a gap, or if eight trials found no size.
/// @param gap_of  the gap for a size, in floors
std::optional<SizedGap> size_for_gap(const std::function<double(double)>& gap_of, const SizeRange& sizes,
                                     const GapAim& aim);

}  // namespace fidservo::selfcheck
