// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/change_points.h"

#include "core/median.h"
#include "src/fleet/report/statistics/censored.h"
#include "src/fleet/report/statistics/change_scan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

namespace fidservo::fleet {
namespace {

constexpr std::size_t most_changes = 4;

/// The points that count where many that were not named are one: of each the index among all of the first
/// that it stands for, and for how many it stands.
struct CountedPoints {
    std::vector<Point> points;
    std::vector<std::size_t> index, stands_for;
};

CountedPoints counted(std::span<const Point> all) {
    CountedPoints kept;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].named() && i > 0 && !all[i - 1].named()) {
            kept.stands_for.back() += 1;
            continue;
        }
        kept.points.push_back(all[i]);
        kept.index.push_back(i);
        kept.stands_for.push_back(1);
    }
    return kept;
}

std::vector<ChangeColumn> columns_of(std::span<const Point> all, std::span<const Change> changes) {
    std::vector<ChangeColumn> columns;
    for (const Change& change : changes) columns.push_back(column_of(change.kind, all, change.first));
    return columns;
}

/// Whether M passes the bound. What comes nowhere near it with normal laws is not integrated over.
bool passes(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> known,
            double log_bound) {
    constexpr double near = 6.0;
    return scan_as_normal(points, scatter, known).log_sum() >= log_bound - near &&
           scan(points, scatter, known).log_sum() >= log_bound;
}

/// Indices of points, those farthest from the median first: an alarm that rests on one diagnosis most often
/// rests on one of these.
std::vector<std::size_t> farthest_first(std::span<const Point> points) {
    std::vector<double> values;
    for (const Point& point : points) values.push_back(point.value);
    const double median = median_of(values);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::size_t k) { return std::abs(points[k].value - median); });
    return order;
}

/// Whether M passes the bound without any one of the diagnoses, too: without any one of the first `count`
/// points that does not stand for several.
bool stands_without_any(const CountedPoints& kept, std::size_t count, const Scatter& scatter,
                        std::span<const ChangeColumn> known, double log_bound) {
    for (const std::size_t left_out : farthest_first(std::span(kept.points).first(count))) {
        if (kept.stands_for[left_out] > 1) continue;
        std::vector<Point> fewer(kept.points.begin(),
                                 kept.points.begin() + static_cast<std::ptrdiff_t>(count));
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(left_out));
        if (!passes(fewer, scatter, known, log_bound)) return false;
    }
    return true;
}

/// The index among all points with which a further change is found first: where it rests on a diagnosis that
/// names nothing, with the second of these.
std::optional<std::size_t> first_alarm(const CountedPoints& kept, const Scatter& scatter,
                                       std::span<const ChangeColumn> known, double log_bound) {
    for (std::size_t count = 2; count <= kept.points.size(); ++count) {
        const std::size_t last = count - 1;
        const std::span<const Point> until(kept.points.data(), count);
        if (!passes(until, scatter, known, log_bound) ||
            !stands_without_any(kept, count, scatter, known, log_bound))
            continue;
        const bool rests_on_last = last < 2 || !passes(until.first(last), scatter, known, log_bound);
        return kept.index[last] + (rests_on_last && kept.stands_for[last] > 1 ? 1 : 0);
    }
    return {};
}

/// Dates a change, the others being as they are, and says of which kind it is.
void date(std::span<const Point> all, const Scatter& scatter, std::span<const ChangeColumn> others,
          Change& change) {
    const ChangeScan dates = scan(all, scatter, others);
    change.kind = dates.log_weight(ChangeKind::step) >= dates.log_weight(ChangeKind::trend)
                      ? ChangeKind::step
                      : ChangeKind::trend;
    const ChangeDates found = dates.dates(change.kind);
    change.first = found.likeliest;
    change.earliest = found.earliest;
    change.latest = found.latest;
}

std::vector<ChangeColumn> all_but(std::span<const Point> all, std::span<const Change> changes,
                                  std::size_t one) {
    std::vector<ChangeColumn> columns;
    for (std::size_t c = 0; c < changes.size(); ++c)
        if (c != one) columns.push_back(column_of(changes[c].kind, all, changes[c].first));
    return columns;
}

/// A step at a time at which many units have changed, beside the unit's other changes.
std::optional<Change> step_at(const CommonStep& common, std::span<const Point> points, const Scatter& scatter,
                              std::span<const Change> others) {
    const auto index_at = [&](double time_weeks) {
        return static_cast<std::size_t>(std::ranges::lower_bound(points, time_weeks, {}, &Point::time_weeks) -
                                        points.begin());
    };
    const std::size_t first = std::max<std::size_t>(1, index_at(common.from_weeks)),
                      end = index_at(common.until_weeks);
    const auto is_here = [&](const Change& change) {
        return first <= change.latest && change.earliest < end;
    };
    if (first >= end || std::ranges::any_of(others, is_here)) return {};
    const auto [log_ratio, likeliest] =
        scan(points, scatter, columns_of(points, others)).step_within(first, end - 1);
    if (log_ratio < least_log_odds) return {};
    Change change;
    change.first = likeliest;
    change.earliest = first;
    change.latest = end - 1;
    change.found = points.size() - 1;
    return change;
}

}  // namespace

double alarm_bound(double quantities, double looks_a_year, double rate) {
    return quantities * looks_a_year / rate;
}

std::vector<Change> find_changes(std::span<const Point> points, const Scatter& scatter, double bound,
                                 std::span<const CommonStep> common) {
    const CountedPoints kept = counted(points);
    const double log_bound = std::log(bound);
    std::vector<Change> changes;
    while (changes.size() < most_changes) {
        const std::vector<ChangeColumn> known = columns_of(points, changes);
        const auto alarm = first_alarm(kept, scatter, known, log_bound);
        if (!alarm) break;
        Change change;
        change.found = *alarm;
        date(points, scatter, known, change);
        changes.push_back(change);
        for (std::size_t c = 0; changes.size() > 1 && c < changes.size(); ++c)
            date(points, scatter, all_but(points, changes, c), changes[c]);
    }
    for (const CommonStep& step : common)
        if (const auto change = step_at(step, points, scatter, changes)) changes.push_back(*change);
    for (std::size_t c = 0; c < changes.size(); ++c) {
        const std::vector<ChangeColumn> others = all_but(points, changes, c);
        const Level size =
            size_of(points, scatter, others, column_of(changes[c].kind, points, changes[c].first));
        changes[c].size = size.value;
        changes[c].std = size.std;
        // With others beside it, it may have come to be dated later than it was found.
        changes[c].found = std::max(changes[c].found, changes[c].first);
        changes[c].log_evidence = std::max(0.0, scan(kept.points, scatter, others).log_sum() - log_bound);
    }
    std::ranges::sort(changes, {}, &Change::first);
    return changes;
}

Level level_now(std::span<const Point> points, const Scatter& scatter, std::span<const Change> changes) {
    std::size_t begin = 0;
    for (const Change& change : changes) {
        if (change.kind == ChangeKind::trend)
            return value_at(counted(points).points, scatter, columns_of(points, changes),
                            points.back().time_weeks);
        begin = std::max(begin, change.first);
    }
    const std::span<const Point> since = points.subspan(begin);
    if (std::ranges::none_of(since, &Point::named))
        return {0.0, std::hypot(since.front().std, scatter.std), since.front().limit};
    const Moments level = over_level(since, scatter.std * scatter.std).moments();
    return {level.mean, std::sqrt(level.variance)};
}

}  // namespace fidservo::fleet
