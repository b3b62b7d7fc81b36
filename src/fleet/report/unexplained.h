// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What diagnoses leave unexplained: gaps that no effect of the catalogue accounts for, of single units or of
// all. Nothing of it shows in sizes of effects, by which units are judged otherwise.
#include "src/fleet/report/series.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// What a unit's last diagnosis leaves.
struct LeftOver {
    std::size_t unit = 0;    ///< of the histories
    double floors = 1.0;     ///< gap with all that is named; 1 is what noise alone leaves
    double before = 1.0;     ///< gap without effects, floors
    std::string block;       ///< where it arises; empty: not said
    std::string campaign;    ///< that was diagnosed
    bool was_ended = false;  ///< the search had not come to its end
};

/// All units' remainders.
struct Unexplained {
    std::vector<LeftOver> units;  ///< those whose last diagnosis leaves something, most first
    std::size_t diagnosed = 0;    ///< units whose last diagnosis is done

    bool empty() const { return units.empty(); }
    /// Eight units in ten or more, of two at least: it is then no matter of one unit.
    bool is_of_all() const;
    /// Half of the units that leave something leave so much or more, floors.
    double median_floors() const;
};

/// A unit leaves something where the last diagnosis says unexplained or partly-explained, and more than 1.1
/// floors are left.
Unexplained unexplained_of(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& units);

/// "4 of 4 units leave 11 floors that nothing known explains."
std::string unexplained_sentence(const Unexplained& unexplained);

/// "All of them leave a gap unexplained", "Unit P-0007 leaves 11 floors unexplained".
std::string unexplained_title(const Unexplained& unexplained, const std::vector<UnitHistory>& units);

/// Each unit with its size, and where it arises; most first. @param most  so many, then how many more
std::vector<std::string> unexplained_lines(const Unexplained& unexplained,
                                           const std::vector<UnitHistory>& units, std::size_t most);

/// What to do about it, in a technician's words.
std::vector<std::string> what_to_do(const Unexplained& unexplained);

}  // namespace fidservo::fleet
