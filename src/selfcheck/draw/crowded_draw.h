// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rigs with many causes at once: three effects, or a messy rig.
//
// A messy rig has one dominant effect, eight small ones, and a discrepancy that no effect of the catalogue
// describes. A gap is drawn for each cause; its size is then scaled until, alone in the rig, it makes this
// gap on the case's own campaign.
#include "src/selfcheck/draw/case_draw.h"

#include <cstdint>

namespace fidservo::selfcheck {

/// Range of the gap, in floors, that each cause of a messy rig causes alone (gap_alone()).
inline constexpr double dominant_floors[] = {10.0, 100.0}, small_floors[] = {0.3, 3.0},
                        discrepancy_floors[] = {1.0, 10.0};
/// Least ratio of the dominant effect's gap to that of any other.
inline constexpr double dominance = 5.0;
inline constexpr std::size_t small_effects = 8;

/// Whether a kind has many causes. These kinds are numbered and drawn separately from the others.
bool is_crowded(CaseKind kind);

/// Of three cases in a row one has three effects, one is messy, and one is messy without its dominant effect.
CaseKind kind_of_crowded_case(std::uint64_t seed, std::size_t number);

/// A pure function of seed and number, as draw_case() is. For three effects, sizes are drawn as for two. A
/// messy case takes some twenty simulated campaigns; about every second of its effects is simulated by
/// another formula than the catalogue's (src/selfcheck/draw/sized_causes.h). Throws std::runtime_error if no
/// size makes a gap within its range.
/// @param nominal  with a micro stage, a camera and controllers
Case draw_crowded_case(const Rig& nominal, std::uint64_t seed, std::size_t number);

}  // namespace fidservo::selfcheck
