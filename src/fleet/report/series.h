// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The results for each quantity of each unit, over time, in floors.
//
// A quantity is a size of an effect of the catalogue: what a unit has of it beyond its rig file. Its size in
// floors is by how much it alone would lift the gap, f = sqrt(g^2 - 1), which each diagnosis states for each
// name (gap_alone, g). Where an effect has several sizes they count by their usual ones:
//
//     floors a unit of size j = median over all names of f / |z|,  divided by usual_j,   z_j = (value_j -
//     vanishing_j) / usual_j
//
// A diagnosis that names the effect with a probability of one half or more gives value and standard error.
// One that does not name it, though it tried it, has passed over what was too small: below 1.1 floors, or
// below what it has left unexplained, nothing is named: the limit L = sqrt(max(1.1, gap after)^2 - 1), with
// the error of diagnoses that name it (statistics/censored.h). It says nothing of an effect that it could not
// tell from one that it names, names with less than one half, or did not come to as its time was over; nor of
// one that its recordings would not show at its typical size, as rest shows no friction.
#include "src/fleet/report/result.h"
#include "src/fleet/report/statistics/point.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// A size parameter of an effect, as a quantity that is observed over time.
struct Quantity {
    std::string effect, parameter, unit, block;  ///< as in the catalogue
    double vanishing = 0.0;                      ///< the value for which the rig file stands
    double floors_per_unit = 0.0;                ///< floors per unit of deviation from it

    double in_floors(double value) const { return (value - vanishing) * floors_per_unit; }
    double in_units(double floors) const { return vanishing + floors / floors_per_unit; }
};

/// A unit's results.
struct UnitHistory {
    std::string name;
    std::vector<std::size_t> results;  ///< indices of results by time; those without a time come first
    /// Index in `results` of the first one that is judged: from there on the rig file is the present one.
    std::size_t first_judged = 0;
};

/// One quantity of one unit.
struct QuantitySeries {
    std::size_t unit = 0;
    std::vector<Point> points;         ///< by time
    std::vector<std::size_t> results;  ///< index of the result for each point
    std::size_t untimed = 0;           ///< number of points at the beginning without a known time
};

/// One quantity of all units that have results on it.
struct QuantityOverFleet {
    Quantity quantity;
    std::vector<QuantitySeries> units;
};

/// Units by name, and their results by time. A result that names no unit is of a unit called like its
/// campaign. Recordings that were diagnosed twice with one rig file, as under two paths, count once.
std::vector<UnitHistory> histories(const std::vector<FleetResult>& results);

/// SHA-256 of the rig file from which a unit's values count.
const std::string& rig_file_of(const std::vector<FleetResult>& results, const UnitHistory& unit);

/// All sizes of effects that some diagnosis names, in the order of the catalogue.
std::vector<QuantityOverFleet> quantities_over_fleet(const std::vector<FleetResult>& results,
                                                     const std::vector<UnitHistory>& units);

/// A sentence for each effect that diagnoses name and the catalogue lacks, as one of an effects file: it is
/// not judged over the fleet.
std::vector<std::string> named_but_not_judged(const std::vector<FleetResult>& results);

/// The number of size parameters in the catalogue: so many quantities are tested in each unit.
std::size_t quantities_looked_at();

/// When a point of a series was recorded, in seconds since 1970-01-01.
/// @param timed  its place among those of which a time is known, as find_changes() counts them
std::int64_t time_s_of(const std::vector<FleetResult>& results, const QuantitySeries& series,
                       std::size_t timed);

/// Weeks since 1970-01-01.
double weeks_of(std::int64_t time_s);

/// Diagnoses of a unit per year, from the median interval between two diagnoses; 52 where it is unknown.
double looks_a_year(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& units);

}  // namespace fidservo::fleet
