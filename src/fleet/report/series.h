// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The results for each quantity of each unit, over time, in floors.
//
// A quantity is a size parameter of an effect of the catalogue; its value is the unit's deviation from its
// rig file. It is converted to floors by the gap g, in floors, that the effect alone would cause, which each
// diagnosis states for each effect that it names (gap_alone): f = sqrt(g^2 - 1). If an effect has several
// size parameters, they are weighted by their usual values:
//
//     floors a unit of size j = median over all names of f / |z|,  divided by usual_j,
//     z_j = (value_j - vanishing_j) / usual_j
//
// A diagnosis that names the effect with a probability of one half or more gives a value with its standard
// error. A diagnosis that tried the effect but does not name it gives a limit: the size is below L =
// sqrt(max(1.1, gap after)^2 - 1) floors, since smaller effects are not named; its error is taken to be that
// of diagnoses that name it (statistics/censored.h). A diagnosis gives no information on an effect that it
// could not distinguish from a named one, that it names with a probability below one half, that it did not
// try before its time was over, or that its recordings would not show at its typical size, as recordings at
// rest do not show friction.
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
    double vanishing = 0.0;                      ///< the value without the effect, as in the rig file
    double floors_per_unit = 0.0;                ///< floors per unit of deviation from `vanishing`

    double in_floors(double value) const { return (value - vanishing) * floors_per_unit; }
    double in_units(double floors) const { return vanishing + floors / floors_per_unit; }
};

/// A unit's results.
struct UnitHistory {
    std::string name;
    std::vector<std::size_t> results;  ///< indices of results by time; those without a time come first
    /// Index in `results` of the first result that is judged: from there on the unit's present rig file was
    /// used.
    std::size_t first_judged = 0;
};

/// One quantity of one unit.
struct QuantitySeries {
    std::size_t unit = 0;
    std::vector<Point> points;         ///< by time
    std::vector<std::size_t> results;  ///< index of the result for each point
    std::size_t untimed = 0;           ///< number of points at the beginning without a known time
};

/// One quantity, for all units whose results give a value or a limit of it.
struct QuantityOverFleet {
    Quantity quantity;
    std::vector<QuantitySeries> units;
};

/// All units, sorted by name, with their results sorted by time. A result that names no unit belongs to a
/// unit named after its campaign. Recordings that were diagnosed several times with the same rig file, for
/// example under two paths, count once.
std::vector<UnitHistory> histories(const std::vector<FleetResult>& results);

/// SHA-256 of the rig file relative to which a unit's values are given.
const std::string& rig_file_of(const std::vector<FleetResult>& results, const UnitHistory& unit);

/// All sizes of effects that some diagnosis names, in the order of the catalogue.
std::vector<QuantityOverFleet> quantities_over_fleet(const std::vector<FleetResult>& results,
                                                     const std::vector<UnitHistory>& units);

/// A sentence for each named effect that is not in the catalogue, such as one of an effects file. Such
/// effects are not judged over the fleet.
std::vector<std::string> named_but_not_judged(const std::vector<FleetResult>& results);

/// The number of size parameters in the catalogue, which is the number of quantities tested in each unit.
std::size_t quantities_looked_at();

/// When a point of a series was recorded, in seconds since 1970-01-01.
/// @param timed  its index among the points with a known time, as in find_changes()
std::int64_t time_s_of(const std::vector<FleetResult>& results, const QuantitySeries& series,
                       std::size_t timed);

/// Weeks since 1970-01-01.
double weeks_of(std::int64_t time_s);

/// Diagnoses of a unit per year, from the median interval between two diagnoses; 52 where it is unknown.
double looks_a_year(const std::vector<FleetResult>& results, const std::vector<UnitHistory>& units);

}  // namespace fidservo::fleet
