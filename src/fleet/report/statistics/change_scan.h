// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The likelihood of a change at each time, beside changes that are known (change_points.h).
#include "src/fleet/report/statistics/change_points.h"

#include <span>
#include <vector>

namespace fidservo::fleet {

/// What a change of size 1 adds, over time.
struct ChangeColumn {
    ChangeKind kind;
    double since_weeks;  ///< of a step, the first time that has it; of a trend, the last that has not

    /// 0 before; 1, or the weeks gone since.
    double at(double time_weeks) const {
        if (kind == ChangeKind::step) return time_weeks >= since_weeks ? 1.0 : 0.0;
        return time_weeks > since_weeks ? time_weeks - since_weeks : 0.0;
    }
};

/// Of a change that a point is the first to have. @param first  1 at least
ChangeColumn column_of(ChangeKind kind, std::span<const Point> points, std::size_t first);

/// The likeliest date of a change and where 95 % of the weight of all dates is; the first point that has it.
struct ChangeDates {
    std::size_t likeliest, earliest, latest;
};

/// E_k for every k, and the likelihoods of their best sizes.
class ChangeScan {
  public:
    explicit ChangeScan(std::size_t points)
        : step_(points, none), trend_(points, none), step_best_(points, none), trend_best_(points, none) {}

    /// log M: the sum over all k, each the mean of step and trend.
    double log_sum() const;
    /// log of the sum of all dates of one kind.
    double log_weight(ChangeKind kind) const;
    ChangeDates dates(ChangeKind kind) const;

    /// @param log_ratio  log E_k of that kind alone
    /// @param log_best  log of the likelihood with the best size
    void set(ChangeKind kind, std::size_t first, double log_ratio, double log_best);
    /// What a stretch of the points says of itself. @param begin  its first point's place
    void set_from(std::size_t begin, const ChangeScan& stretch);

  private:
    static constexpr double none = -1e300;
    std::vector<double> step_, trend_, step_best_, trend_best_;  ///< by the first point that has the change
};

/// The laws that sizes of changes are drawn from: their standard deviations, floors or floors a week.
std::span<const double> laws_of(ChangeKind kind);

/// Points that are not named count by their limits (limited_scan.h); beside a trend, and where nothing is
/// known of the scatter's scale, as normal laws (as_normal()).
/// @param known  changes that are there in any case
ChangeScan scan(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> known);

/// Likewise with all that is not named as normal laws: quicker, and near it.
ChangeScan scan_as_normal(std::span<const Point> points, const Scatter& scatter,
                          std::span<const ChangeColumn> known);

/// The size of one change beside others; floors, or floors a week.
Level size_of(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> others,
              const ChangeColumn& change);

/// The value at a time by a level and changes. Beside trends, what is not named counts as normal laws.
Level value_at(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> changes,
               double time_weeks);

}  // namespace fidservo::fleet
