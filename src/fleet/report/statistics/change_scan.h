// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The likelihood of a change at each time, in addition to known changes (change_points.h).
#include "src/fleet/report/statistics/change_points.h"

#include <span>
#include <vector>

namespace fidservo::fleet {

/// The contribution of a change of size 1, over time.
struct ChangeColumn {
    ChangeKind kind;
    /// For a step, the time of the first point with the change; for a trend, of the last one without.
    double since_weeks;

    /// 0 before the change; then 1 for a step, or the weeks since for a trend.
    double at(double time_weeks) const {
        if (kind == ChangeKind::step) return time_weeks >= since_weeks ? 1.0 : 0.0;
        return time_weeks > since_weeks ? time_weeks - since_weeks : 0.0;
    }
};

/// The column of a change whose first point is given.
/// @param first  1 at least
ChangeColumn column_of(ChangeKind kind, std::span<const Point> points, std::size_t first);

/// The most probable date of a change and its 95 % interval, as indices of the first point with the change.
struct ChangeDates {
    std::size_t likeliest, earliest, latest;
};

/// E_k for every k, and the likelihoods of their best sizes.
class ChangeScan {
  public:
    explicit ChangeScan(std::size_t points)
        : step_(points, none), trend_(points, none), step_best_(points, none), trend_best_(points, none) {}

    /// log M: the sum over all dates k, each the mean of step and trend.
    double log_sum() const;
    /// log of the sum over all dates of one kind.
    double log_weight(ChangeKind kind) const;
    ChangeDates dates(ChangeKind kind) const;
    /// log of the mean E_k of a step over dates from first to last, and the likeliest of these.
    struct StepWithin {
        double log_ratio;
        std::size_t likeliest;
    };
    StepWithin step_within(std::size_t first, std::size_t last) const;

    /// @param log_ratio  log E_k for that kind
    /// @param log_best  log of the likelihood with the best size
    void set(ChangeKind kind, std::size_t first, double log_ratio, double log_best);
    /// Copies the results of the scan of one stretch of the points.
    /// @param begin  index of the stretch's first point
    void set_from(std::size_t begin, const ChangeScan& stretch);

  private:
    static constexpr double none = -1e300;
    /// by the index of the first point with the change.
    std::vector<double> step_, trend_, step_best_, trend_best_;
};

/// The prior standard deviations of a change's size, floors or floors per week.
std::span<const double> laws_of(ChangeKind kind);

/// Scans all dates. Points that are not named enter by their limits (limited_scan.h); but as normal
/// distributions (as_normal()) if a trend is known, or if nothing is known of the scale of the scatter.
/// @param known  changes that were found before
ChangeScan scan(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> known);

/// scan() with all points that are not named as normal distributions: an approximation that is faster.
ChangeScan scan_as_normal(std::span<const Point> points, const Scatter& scatter,
                          std::span<const ChangeColumn> known);

/// The size of one change beside others; floors, or floors a week.
Level size_of(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> others,
              const ChangeColumn& change);

/// The value at a time, from the level and the given changes. If there is a trend among these, points that
/// are not named enter as normal distributions.
Level value_at(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> changes,
               double time_weeks);

}  // namespace fidservo::fleet
