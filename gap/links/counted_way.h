// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The way that a carriage has covered by its counts, and what its mechanism remembers of it: how far its
// bristles are bent (plant/friction.h), and on which side of its play it is (plant/transmission.h). Both
// follow from the way alone, so that counts tell them where no simulation has come from: at the start of a
// stretch, or behind windows that nobody wants.
//
// Where a count changes, the carriage is at the border of two counts. Between, its place is taken to be the
// nearest to the last one that rounds to the count (a play operator one count wide).
#include "plant/macro_axis.h"

#include <cstddef>
#include <vector>

namespace fidservo::gap {

/// Where the carriage turned round, or began.
struct Turn {
    std::size_t row;
    double place_count;
};

struct CountedWay {
    std::vector<double> place_count;  ///< row by row; NaN before the first reading
    std::vector<Turn> turns;          ///< by row
};

/// @param reading_count  row by row, NaN where missing
CountedWay counted_way(const std::vector<double>& reading_count);

/// How much way was covered up to a row, whichever way it went, in counts.
double covered_count(const CountedWay& way, std::size_t row);

/// Whether a mechanism, or a formula, remembers anything of its way.
bool remembers(const plant::MacroAxis& axis);

/// What a mechanism remembers at a row, whose bristles were straight, and whose play was in its middle, where
/// the counts begin.
plant::MechanismState remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count,
                                 std::size_t row);

/// Whether that is as certain as a simulation: there is nothing to remember, or the carriage is on its way
/// there and beyond, and has been for long enough to have forgotten all that was before.
bool is_remembered(const CountedWay& way, const plant::MacroAxis& axis, double mm_per_count, std::size_t row);

}  // namespace fidservo::gap
