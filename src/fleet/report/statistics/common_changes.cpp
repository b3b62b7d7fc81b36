// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/common_changes.h"

#include "src/fleet/report/statistics/censored.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace fidservo::fleet {
namespace {

/// A point of a unit, with what is not named as a normal law.
struct PlacedPoint {
    std::size_t unit, period;
    double value, variance;
};

/// The points of units in periods since the first of them; periods without points are not counted.
struct InPeriods {
    std::size_t units = 0;
    std::vector<PlacedPoint> points;
    std::vector<double> begin_weeks;  ///< of each period
};

InPeriods in_periods(std::span<const std::vector<Point>> units, double period_weeks) {
    InPeriods placed;
    std::vector<const std::vector<Point>*> named;
    double first_weeks = INFINITY;
    for (const std::vector<Point>& unit : units) {
        if (std::ranges::none_of(unit, &Point::named)) continue;
        named.push_back(&unit);
        first_weeks = std::min(first_weeks, unit.front().time_weeks);
    }
    placed.units = named.size();
    const auto period_of = [&](const Point& point) {
        return std::floor((point.time_weeks - first_weeks) / period_weeks);
    };
    std::map<double, std::size_t> places;
    for (const auto* unit : named)
        for (const Point& point : *unit) places.emplace(period_of(point), 0);
    for (auto& [period, place] : places) {
        place = placed.begin_weeks.size();
        placed.begin_weeks.push_back(first_weeks + period * period_weeks);
    }
    for (std::size_t u = 0; u < named.size(); ++u)
        for (const Point& point : *named[u]) {
            const Point normal = as_normal(point);
            placed.points.push_back({u, places.at(period_of(point)), normal.value, normal.std * normal.std});
        }
    return placed;
}

/// Means of what is left at each place, by one of the two indices of the points.
void take_means(std::vector<double>& means, const InPeriods& placed, std::size_t PlacedPoint::*index,
                const std::vector<double>& others, std::size_t PlacedPoint::*other_index) {
    std::vector<double> counts(means.size(), 0.0);
    std::ranges::fill(means, 0.0);
    for (const PlacedPoint& point : placed.points) {
        means[point.*index] += point.value - others[point.*other_index];
        counts[point.*index] += 1.0;
    }
    for (std::size_t k = 0; k < means.size(); ++k) means[k] /= counts[k];
}

/// c, as the points of one unit.
std::vector<Point> common_course(const InPeriods& placed) {
    constexpr int sweeps = 50;  // exact after the first where all units have all periods
    std::vector<double> of_unit(placed.units, 0.0), of_period(placed.begin_weeks.size(), 0.0);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        take_means(of_unit, placed, &PlacedPoint::unit, of_period, &PlacedPoint::period);
        take_means(of_period, placed, &PlacedPoint::period, of_unit, &PlacedPoint::unit);
    }
    std::vector<double> counts(of_period.size(), 0.0), variances(of_period.size(), 0.0);
    for (const PlacedPoint& point : placed.points) {
        counts[point.period] += 1.0;
        variances[point.period] += point.variance;
    }
    std::vector<Point> course;
    for (std::size_t p = 0; p < of_period.size(); ++p)
        course.push_back({placed.begin_weeks[p], of_period[p], std::sqrt(variances[p]) / counts[p]});
    return course;
}

}  // namespace

CommonChanges common_changes(std::span<const std::vector<Point>> units, double period_weeks, double bound) {
    const InPeriods placed = in_periods(units, period_weeks);
    if (placed.units < 2) return {};
    const std::vector<Point> course = common_course(placed);
    CommonChanges common;
    std::set<double> cuts;
    for (const Change& change : find_changes(course, {.std = 0.0, .degrees = 0.0}, bound)) {
        const bool is_step = change.kind == ChangeKind::step;
        const std::size_t first = change.earliest - 1, last = std::min(change.latest + 1, course.size() - 1);
        if (is_step)
            common.steps.push_back(
                {course[first].time_weeks, course[change.latest].time_weeks + period_weeks});
        for (std::size_t p = first; p <= (is_step ? last : course.size() - 1); p += is_step ? 1 : 2)
            cuts.insert(course[p].time_weeks);
    }
    common.cuts.assign(cuts.begin(), cuts.end());
    return common;
}

std::vector<std::vector<Point>> stretches_of(std::span<const Point> points, std::span<const double> cuts) {
    std::vector<std::vector<Point>> stretches;
    std::ptrdiff_t stretch = -1;
    for (const Point& point : points) {
        const auto here = std::ranges::upper_bound(cuts, point.time_weeks) - cuts.begin();
        if (here != stretch) stretches.emplace_back();
        stretch = here;
        stretches.back().push_back(point);
    }
    return stretches;
}

}  // namespace fidservo::fleet
