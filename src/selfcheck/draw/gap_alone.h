// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How large a gap is that one cause makes by itself, and the size at which it makes one of a given size.
#include "src/selfcheck/draw/true_rig.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace fidservo::selfcheck {

/// What a rig adds to the gap over all signals of its campaign as the nominal rig predicts it, in floors:
/// sqrt(gap^2 - 1). About 0.1 of a rig that is as its file says.
double gap_alone(const Rig& nominal, const TrueRig& rig, std::uint64_t campaign_seed);

/// A gap to come to, in floors.
struct GapAim {
    double low, high;  ///< what is allowed
    double target;     ///< between them
};

/// Of a cause's size, in its unit.
struct SizeRange {
    double start;    ///< where the search begins
    double largest;  ///< beyond it a rig would be called broken
};

struct SizedGap {
    double size, gap_floors;
};

/// A size whose gap is allowed and, unless the gap jumps there, within a half of the target: in proportion
/// at first, by bisection in the logarithm once the target lies between two sizes. Empty where the largest
/// size is too small, or where none was found in eight trials.
/// @param gap_of  gap of a size, in floors
std::optional<SizedGap> size_for_gap(const std::function<double(double)>& gap_of, const SizeRange& sizes,
                                     const GapAim& aim);

}  // namespace fidservo::selfcheck
