// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether, when and how a unit has changed.
//
// At every diagnosis each time k since which the unit may have changed, by a step or by a trend of a size
// that is drawn from a normal law about nothing, has the ratio of likelihoods
//
//     E_k = p(y_1 .. y_t | changed since k) / p(y_1 .. y_t | unchanged)
//
// with the unknown level and scale integrated out (contrasts, Student's law; within_scatter.h); of a
// diagnosis that does not name the quantity the likelihood is that of seeing nothing (limited_scan.h). While
// nothing changes, each E_k is a martingale of mean 1, so that their sum M_t = sum_k E_k (Shiryaev and
// Roberts) minus the number of looks is one, too, and the mean number of looks before M passes a bound A is
// at least A. With
//
//     A = quantities * looks a year / rate
//
// all quantities together raise at most `rate` false alarms a unit-year, however often one looks. That holds
// for any law of sizes; it is a mean over steps of 1, 4 and 16 floors, and trends of a quarter of that a
// week.
//
// An alarm counts where it stands without any one of the diagnoses, too: a single one may be wrong by more
// than its error says. A run of diagnoses that do not name the effect counts as one: what the first passes
// over the others pass over as well.
//
// Of what was found the date is that of the largest likelihood, and its interval holds 95 % of the weight of
// all dates; there every diagnosis counts. Further changes are looked for beside those that were found.
// Sources: Shiryaev, Theory Probab. Appl. 8, 1963; Roberts, Technometrics 8, 1966; sums of e-processes: Shin,
// Ramdas, Rinaldo, New Engl. J. Stat. Data Sci. 2, 2024; invariance under level and scale: Perez-Ortiz et
// al., Ann. Stat. 52, 2024.
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
/// @param quantities  tested in a unit
/// @param looks_a_year  diagnoses of a unit per year
/// @param rate  of false alarms, per unit and year
double alarm_bound(double quantities, double looks_a_year, double rate);

/// @param points  of one unit, by time
/// @param scatter  of such units that do not change, not learnt from this one
/// @param bound  alarm_bound()
/// @param common  where a step of this unit was not looked for, but is as likely as none: one that raises no
/// alarm counts where its likelihood ratio is 19 or more
/// By time.
std::vector<Change> find_changes(std::span<const Point> points, const Scatter& scatter, double bound,
                                 std::span<const CommonStep> common = {});

/// The present value, from the points and their changes. If no point since the last change is named, the
/// value is a limit.
Level level_now(std::span<const Point> points, const Scatter& scatter, std::span<const Change> changes);

}  // namespace fidservo::fleet
