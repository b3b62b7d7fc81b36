// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the results of a fleet come to: what is wrong with the model, a batch, a unit; what has changed and
// since when.
#include "src/fleet/report/series.h"
#include "src/fleet/report/statistics/attribution.h"
#include "src/fleet/report/statistics/change_points.h"
#include "src/fleet/report/statistics/population.h"
#include "src/fleet/report/statistics/within_scatter.h"
#include "src/fleet/report/unexplained.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// False alarms over all quantities, for one unit and year.
inline constexpr double false_alarms_a_unit_year = 0.05;

/// Units that may share a cause.
struct UnitGroup {
    std::string name;                ///< "batch 7", "first recorded in the week of 2026-11-02"
    std::vector<std::size_t> units;  ///< of FleetFindings::units
};

/// One quantity of one unit.
struct UnitFindings {
    QuantitySeries series;
    std::vector<Change> changes;  ///< places among the series' points
    Level known;                  ///< now, by its own diagnoses; with a limit where they name nothing
    Level level;                  ///< the same as a normal law
    Level pooled;                 ///< the same given the fleet
};

/// One quantity.
struct QuantityFindings {
    Quantity quantity;
    std::vector<UnitFindings> units;
    Scatter scatter;                ///< of units that have not changed
    Population population;          ///< of units that share in no deviation of their own
    std::vector<UnitGroup> groups;  ///< sets that were compared; units are places in `units`
    Attribution attribution;        ///< units and groups are places in `units` and `groups`
};

/// Dates between which something began: it was not there at the one and was there at the other.
struct Dates {
    std::int64_t earliest_s, likeliest_s, latest_s;
};

/// What a judgement is about.
enum class Matter {
    deviation,  ///< of one unit, a batch, all
    step,       ///< at a date
    trend,      ///< since a date, going on
};

/// Something that somebody should do something about.
struct Judgement {
    Matter matter = Matter::deviation;
    Whose whose = Whose::unit;
    std::size_t quantity = 0;        ///< of FleetFindings::quantities
    std::vector<std::size_t> units;  ///< of FleetFindings::units
    std::string group;               ///< the batch's name; empty where it is none
    /// In floors; of a trend, floors a week. Of several units' changes their mean.
    Level size;
    double now = 0.0;                     ///< where it stands now, floors beyond the rig file
    std::optional<Dates> since;           ///< of a change
    std::optional<std::int64_t> found_s;  ///< with the diagnosis of which time it was found first
    double probability = 1.0;             ///< of a deviation: that it is whose it is said to be
    double log_odds = 0.0;  ///< natural: against none of it; of a change, over the bound of an alarm
    double log_all = 0.0, log_group = 0.0, log_unit = 0.0;  ///< of a deviation (Share)
};

/// All of it.
struct FleetFindings {
    std::vector<UnitHistory> units;
    std::vector<QuantityFindings> quantities;
    Unexplained unexplained;            ///< what no effect accounts for
    std::vector<Judgement> judgements;  ///< most serious first
    double looks_a_year = 52.0;
    double bound = 1.0;  ///< of an alarm (change_points.h)
};

/// Of a quantity's units, those that have a share of their own or of their batch.
std::vector<bool> odd_units(const QuantityFindings& found);

FleetFindings findings_of(const std::vector<FleetResult>& results);

}  // namespace fidservo::fleet
