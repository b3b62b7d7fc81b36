// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether, when and how a unit has changed.
//
// After every diagnosis t, a likelihood ratio is computed for each time k since which the unit may have
// changed, by a step or by a trend whose size has a normal prior with mean 0:
//
//     E_k = p(y_1 .. y_t | changed since k) / p(y_1 .. y_t | unchanged)
//
// The unknown level and scale are integrated out (contrasts, Student's distribution; within_scatter.h); a
// diagnosis that does not name the quantity has the likelihood of not detecting it (limited_scan.h). While
// nothing changes, each E_k is a martingale of mean 1. Their sum M_t = sum_k E_k (Shiryaev and Roberts) minus
// the number of diagnoses is then a martingale, too, so that the mean number of diagnoses before M exceeds a
// bound A is at least A. With
//
//     A = quantities * looks a year / rate
//
// all quantities together raise at most `rate` false alarms per unit and year, however often the report is
// made. That holds for any prior of the sizes; the one used has standard deviations of 1, 4 and 16 floors for
// steps and a quarter of these per week for trends, with equal weights.
//
// An alarm counts only if it persists when any single diagnosis is left out, since a single diagnosis may be
// wrong by far more than its standard error. Consecutive diagnoses that do not name the effect are left out
// together, since their errors are alike.
//
// The date of a change is that of the largest likelihood, with all diagnoses; its interval contains 95 % of
// the summed likelihood of all dates. After a change was found, further changes are searched for in addition
// to it. Sources: Shiryaev, Theory Probab. Appl. 8, 1963; Roberts, Technometrics 8, 1966; sums of
// e-processes: Shin, Ramdas, Rinaldo, New Engl. J. Stat. Data Sci. 2, 2024; invariance under level and scale:
// Perez-Ortiz et al., Ann. Stat. 52, 2024.
#include "src/fleet/report/statistics/point.h"
#include "src/fleet/report/statistics/within_scatter.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::fleet {

/// The kind of a change.
enum class ChangeKind {
    step,   ///< from one diagnosis to the next
    trend,  ///< by the same amount each week
};

/// A change of one unit's quantity.
struct Change {
    ChangeKind kind = ChangeKind::step;
    std::size_t first = 0;                 ///< index of the first point with the change
    std::size_t earliest = 0, latest = 0;  ///< 95 % interval of that index
    std::size_t found = 0;                 ///< index of the point with which the change was found
    double size = 0.0, std = 0.0;          ///< floors, or floors a week
    double log_evidence = 0.0;             ///< log(M / A) with all points, 0 at least
};

/// A time in which many units have changed (common_changes.h): the first diagnosis with the change is at
/// `from_weeks` or later, and before `until_weeks`.
struct CommonStep {
    double from_weeks, until_weeks;
};

/// The alarm bound A.
/// @param quantities  number of quantities that are tested in a unit
/// @param looks_a_year  diagnoses of a unit per year
/// @param rate  of false alarms, per unit and year
double alarm_bound(double quantities, double looks_a_year, double rate);

/// @param points  of one unit, by time
/// @param scatter  of units that do not change, estimated without this unit
/// @param bound  alarm_bound()
/// @param common  times at which many units have changed. A step of this unit there has even prior odds: it
/// also counts without an alarm if its likelihood ratio is 19 or more
/// @return the changes, by time
std::vector<Change> find_changes(std::span<const Point> points, const Scatter& scatter, double bound,
                                 std::span<const CommonStep> common = {});

/// The present value, from the points and their changes. If no diagnosis since the last change names the
/// quantity, the value is a limit.
Level level_now(std::span<const Point> points, const Scatter& scatter, std::span<const Change> changes);

}  // namespace fidservo::fleet
