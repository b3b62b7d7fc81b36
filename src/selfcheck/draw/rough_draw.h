// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rigs that no explanation brings near the floor, as those of real machines with a fine encoder: two large
// effects of one stage, and on the same stage a discrepancy of many floors that no effect has.
#include "src/selfcheck/draw/case_draw.h"

#include <cstdint>

namespace fidservo::selfcheck {

/// Range of the gap, in floors, that the larger effect causes alone (gap_alone()).
inline constexpr double rough_floors[] = {30.0, 1000.0};
/// Of the larger effect's gap: the range of that of the other one alone, and of the discrepancy alone.
inline constexpr double rough_second[] = {0.1, 1.0}, rough_discrepancy[] = {0.02, 0.3};

/// Always CaseKind::rough.
CaseKind kind_of_rough_case(std::uint64_t seed, std::size_t number);

/// A pure function of seed and number, as draw_case() is. The larger effect is the label's first. Every
/// second effect is made by another formula than the catalogue's (src/selfcheck/draw/other_formulas.h).
/// Throws std::runtime_error where no size makes a gap that was drawn.
/// @param nominal  with a micro stage, a camera and controllers
Case draw_rough_case(const Rig& nominal, std::uint64_t seed, std::size_t number);

}  // namespace fidservo::selfcheck
