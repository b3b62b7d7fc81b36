// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The distance that a carriage has covered according to its counts, and what its mechanism remembers of it:
// how far its bristles are deflected (plant/friction.h), and on which side of its play it is
// (plant/transmission.h). Both follow from the motion alone, so that counts tell them where no simulation
// leads: at the start of a stretch, or after windows that are not wanted.
//
// Where the count changes, the carriage is at the border of two counts. In between, its position is taken to
// be the one nearest to the last position that rounds to the count (a play operator one count wide).
#include "plant/macro_axis.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// A row at which the carriage reversed, or the first one.
struct Turn {
    std::size_t row;
    double place_count;
};

struct CountedWay {
    std::vector<double> place_count;  ///< row by row; NaN before the first reading
    std::vector<Turn> turns;          ///< sorted by row
};

/// @param reading_count  row by row, NaN where missing
CountedWay counted_way(const std::vector<double>& reading_count);

/// The distance covered up to a row, in both directions together, in counts.
double covered_count(const CountedWay& way, std::size_t row);

/// Whether a mechanism, or a formula, depends on its past motion.
bool remembers(const plant::MacroAxis& axis);

/// What a mechanism remembers at a row, if its bristles were straight and its play was centred at the first
/// count.
plant::MechanismState remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count,
                                 std::size_t row);

/// Whether the result of remembered() is as certain as a simulation: there is nothing to remember, or the
/// carriage moves in one direction through the row and has covered enough distance to forget all that was
/// before.
bool is_remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count, std::size_t row);

}  // namespace fidservo::gap
