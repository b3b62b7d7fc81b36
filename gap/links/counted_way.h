// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The distance that a carriage has covered according to its counts, and the state of its mechanism that
// follows from it: the deflection of the bristles (plant/friction.h) and the side of the play on which the
// carriage is (plant/transmission.h). This state depends on the past motion alone, so that it can be taken
// from the counts where no simulation precedes: at the start of a stretch, or after windows that are not
// simulated.
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

/// A mechanism's state at a row, if the bristles were straight and the play was centred at the first count.
plant::MechanismState remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count,
                                 std::size_t row);

/// Whether the result of remembered() is as certain as a simulated state: the mechanism has no such state, or
/// the carriage moves through the row in one direction and has covered enough distance in it that the state
/// no longer depends on earlier motion.
bool is_remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count, std::size_t row);

}  // namespace fidservo::gap
