// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the lines above a table's rows say of a column's unit.
#include "src/files/table/plain_table.h"

#include <string>
#include <vector>

namespace fidservo {

/// A unit that a line above the rows names, and that may be a column's.
struct PossibleUnit {
    std::string unit;  ///< find_unit()'s name
    int line;
    std::string text;  ///< of the line, or of the column's title
};

struct UnitAbove {
    std::string unit = {};  ///< find_unit()'s name, or as written if that does not know it; else empty
    std::vector<PossibleUnit> possible = {};  ///< where no unit is stated
};

/// The unit in a title of the column (column_units.h), in any line that has a field for each column, or in a
/// line of units: below a title, or one that holds nothing else, above or below any other line. Units that
/// other lines name are possible ones; so is a title that is a unit's name, where it stands alone. Throws
/// InputError "FILE:LINE: ..." if titles give two different ones.
UnitAbove unit_above(const PlainTable& table, std::size_t column);

/// Throws InputError "FILE:LINE: ..." where a line above the rows has factors for its columns, as
/// "scale;0.001;0.001": they would be passed over.
void demand_no_factors(const PlainTable& table);

}  // namespace fidservo
