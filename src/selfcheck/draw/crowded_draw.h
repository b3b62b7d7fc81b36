// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rigs with many causes at once: three effects, or a messy rig.
//
// A messy rig has one dominant effect, eight small ones, and a discrepancy that no effect has. How large each
// is alone is measured on the case's own campaign, and its size is scaled until the gap that it makes is one
// that was drawn.
#include "src/selfcheck/draw/case_draw.h"

#include <cstdint>

namespace fidservo::selfcheck {

/// Range of the gap, in floors, that each cause of a messy rig causes alone (gap_alone()).
inline constexpr double dominant_floors[] = {10.0, 100.0}, small_floors[] = {0.3, 3.0},
                        discrepancy_floors[] = {1.0, 10.0};
/// Least ratio of the dominant effect's gap to that of any other.
inline constexpr double dominance = 5.0;
inline constexpr std::size_t small_effects = 8;

/// Whether a kind is one of these. They are drawn separately from the other kinds.
bool is_crowded(CaseKind kind);

/// Of three cases in a row one has three effects, one is messy, and one has no dominant effect.
CaseKind kind_of_crowded_case(std::uint64_t seed, std::size_t number);

/// A pure function of seed and number, as draw_case() is. Of three effects the sizes are drawn as those of
/// two are; a messy case takes some twenty simulated campaigns. Of a messy rig's effects every second one, or
/// the next after it that can be, is made by another formula than the catalogue's
/// (src/selfcheck/draw/other_formulas.h).
/// Throws std::runtime_error where no size makes a gap that was drawn.
/// @param nominal  with a micro stage, a camera and controllers
Case draw_crowded_case(const Rig& nominal, std::uint64_t seed, std::size_t number);

}  // namespace fidservo::selfcheck
