// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Gaps that no effect of the catalogue explains, of single units or of all. They are judged separately, since
// they do not change the sizes of effects.
#include "src/fleet/report/series.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// The remaining gap in a unit's last diagnosis that succeeded.
struct LeftOver {
    std::size_t unit = 0;    ///< index in the histories
    double floors = 1.0;     ///< gap with all named effects; 1 is noise alone
    double before = 1.0;     ///< gap without effects, floors
    std::string block;       ///< the accused block; empty: none is stated
    std::string campaign;    ///< the campaign of that diagnosis
    bool was_ended = false;  ///< the search had been cut short
};

/// All units' remainders.
struct Unexplained {
    std::vector<LeftOver> units;             ///< units with a remaining gap, the largest first
    std::size_t diagnosed = 0;               ///< number of units with a successful diagnosis
    std::vector<std::size_t> not_diagnosed;  ///< units whose last campaign could not be diagnosed

    bool empty() const { return units.empty(); }
    /// Whether at least two units, and 80 % of all, have a remaining gap, so that its cause is not in single
    /// units.
    bool is_of_all() const;
    /// The median of the remaining gaps, floors.
    double median_floors() const;
};

/// A unit has a remaining gap if its last successful diagnosis has the verdict unexplained or
/// partly-explained and leaves more than 1.1 floors.
Unexplained unexplained_of(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& units);

/// "2 of 7 units could not be diagnosed when they were recorded last: U-3 and U-5." Empty if all could.
std::string not_diagnosed_sentence(const Unexplained& unexplained, const std::vector<UnitHistory>& units);

/// "4 of 4 units leave 11 floors that nothing known explains."
std::string unexplained_sentence(const Unexplained& unexplained);

/// "All of them leave a gap unexplained", "Unit P-0007 leaves 11 floors unexplained".
std::string unexplained_title(const Unexplained& unexplained, const std::vector<UnitHistory>& units);

/// Each unit with the size and the block of its gap, the largest first.
/// @param most  largest number of lines; then the number of the others
std::vector<std::string> unexplained_lines(const Unexplained& unexplained,
                                           const std::vector<UnitHistory>& units, std::size_t most);

/// What to do about it, in a technician's words.
std::vector<std::string> what_to_do(const Unexplained& unexplained);

}  // namespace fidservo::fleet
