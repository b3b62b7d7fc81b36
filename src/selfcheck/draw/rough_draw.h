// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rigs whose errors no explanation brings near the floor, as is usual for real machines with a fine encoder:
// two large effects on one stage, and on the same stage a discrepancy of many floors that no effect of the
// catalogue describes.
#include "src/selfcheck/draw/case_draw.h"

#include <cstdint>

namespace fidservo::selfcheck {

/// Range of the gap, in floors, that the larger effect causes alone (gap_alone()).
inline constexpr double rough_floors[] = {30.0, 1000.0};
/// Ranges of the gap that the second effect causes alone and of the gap that the discrepancy causes alone, as
/// fractions of the larger effect's gap.
inline constexpr double rough_second[] = {0.1, 1.0}, rough_discrepancy[] = {0.02, 0.3};

/// Always CaseKind::rough.
CaseKind kind_of_rough_case(std::uint64_t seed, std::size_t number);

/// A pure function of seed and number, as draw_case() is. The larger effect is the label's first. Every
/// second effect is simulated by another formula than the catalogue's (src/selfcheck/draw/other_formulas.h).
/// Throws std::runtime_error if no size of a cause makes a gap within its range.
/// @param nominal  with a micro stage, a camera and controllers
Case draw_rough_case(const Rig& nominal, std::uint64_t seed, std::size_t number);

}  // namespace fidservo::selfcheck
