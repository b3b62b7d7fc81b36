// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The findings from a fleet's results: deviations of all units (the model is wrong), of a batch or of a unit,
// and changes with their dates.
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

/// Expected number of false alarms over all quantities, per unit and year.
inline constexpr double false_alarms_a_unit_year = 0.05;

/// Units that may share a cause.
struct UnitGroup {
    std::string name;                ///< "batch 7", "first recorded in the week of 2026-11-02"
    std::vector<std::size_t> units;  ///< of FleetFindings::units
};

/// One quantity of one unit.
struct UnitFindings {
    QuantitySeries series;
    std::vector<Change> changes;  ///< their times are indices of the series' points
    Level known;   ///< present value by the unit's own diagnoses; a limit if they do not name the effect
    Level level;   ///< `known` as a normal distribution (as_normal())
    Level pooled;  ///< present value given the fleet (population.h)
};

/// One quantity.
struct QuantityFindings {
    Quantity quantity;
    std::vector<UnitFindings> units;
    Scatter scatter;                ///< scatter of units that have not changed
    Population population;          ///< distribution of the units without a deviation of their own
    std::vector<UnitGroup> groups;  ///< groups that were compared; units are indices in `units`
    Attribution attribution;        ///< units and groups are indices in `units` and `groups`
};

/// The interval of the date at which something began, and its most likely date; seconds since 1970-01-01 UTC.
struct Dates {
    std::int64_t earliest_s, likeliest_s, latest_s;
};

/// The kind of a judgement.
enum class Matter {
    deviation,  ///< of one unit, a batch or all units
    step,       ///< a sudden change at a date
    trend,      ///< a continuing change since a date
};

/// A finding that needs action.
struct Judgement {
    Matter matter = Matter::deviation;
    Whose whose = Whose::unit;
    std::size_t quantity = 0;        ///< index in FleetFindings::quantities
    std::vector<std::size_t> units;  ///< indices in FleetFindings::units
    std::string group;               ///< the batch's name; empty if it is no batch
    /// The size in floors; of a trend, in floors per week. For changes of several units, their mean.
    Level size;
    double now = 0.0;  ///< present value, floors relative to the rig file
    /// Of a deviation: its units also have a deviation in common with other units; `size` is the difference
    /// from that.
    bool is_beside_others = false;
    /// Of a deviation: its units were diagnosed with rig files that no other unit was diagnosed with. Values
    /// are relative to the rig file, so that the files may differ rather than the units.
    bool is_by_rig_file = false;
    std::optional<Dates> since;           ///< of a change
    std::optional<std::int64_t> found_s;  ///< time of the diagnosis with which it was first found
    double probability = 1.0;  ///< of a deviation: probability that it belongs to this unit, batch or all
    /// Natural log odds of a deviation against none; of a change, over the alarm bound.
    double log_odds = 0.0;
    double log_all = 0.0, log_group = 0.0, log_unit = 0.0;  ///< of a deviation, as in Share
};

/// All findings.
struct FleetFindings {
    std::vector<UnitHistory> units;
    std::vector<QuantityFindings> quantities;
    Unexplained unexplained;            ///< gaps that no effect explains
    std::vector<Judgement> judgements;  ///< most serious first
    double looks_a_year = 52.0;
    double bound = 1.0;  ///< alarm bound (change_points.h)
};

/// For each unit of a quantity, whether it or its batch has a deviation.
std::vector<bool> odd_units(const QuantityFindings& found);

FleetFindings findings_of(const std::vector<FleetResult>& results);

}  // namespace fidservo::fleet
