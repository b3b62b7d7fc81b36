// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/change_scan.h"

#include "core/demand.h"
#include "src/fleet/report/statistics/censored.h"
#include "src/fleet/report/statistics/limited_scan.h"
#include "src/fleet/report/statistics/log_of_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

namespace fidservo::fleet {
namespace {

constexpr std::array step_laws{1.0, 4.0, 16.0};
constexpr std::array trend_laws{0.25, 1.0, 4.0};

double weight_of(const Point& point, const Scatter& scatter) {
    return 1.0 / (point.std * point.std + scatter.std * scatter.std);
}

/// Of a column beside what is there in any case: its own weighted square, and its product with the values.
struct ColumnFit {
    double square, product;
};

/// What is left without a change: the weighted squares, and how many contrasts they are of.
struct Unchanged {
    double squares, contrasts;
};

/// log E of a column whose size is drawn from N(0, phi law^2), its mean over the laws; and of the best size.
struct LogRatio {
    double mean, best;
};

template <std::size_t count>
LogRatio log_ratio(const ColumnFit& column, const Unchanged& unchanged, double degrees,
                   const std::array<double, count>& laws) {
    if (!(column.square > 1e-12)) return {0.0, 0.0};
    const double all = degrees + unchanged.squares;
    const double power = 0.5 * (degrees + unchanged.contrasts);
    const double least = 1e-12;  // of the squares that a change leaves, where their scale is not known
    const auto log_of = [&](double explained) {
        return all > 0.0 ? -power * std::log(std::max(least, 1.0 - explained / all)) : 0.0;
    };
    std::array<double, count> terms{};
    for (std::size_t k = 0; k < count; ++k) {
        const double gain = laws[k] * laws[k] * column.square;
        const double explained = column.product * column.product / column.square * gain / (1.0 + gain);
        terms[k] = -0.5 * std::log1p(gain) + log_of(explained);
    }
    return {log_of_sum(terms) - std::log(static_cast<double>(count)),
            log_of(column.product * column.product / column.square)};
}

/// Only a level is there in any case: all sums over the points after k are had from the end on.
ChangeScan scan_beside_level(std::span<const Point> points, const Scatter& scatter) {
    ChangeScan result(points.size());
    const double origin = points.front().value, end_weeks = points.back().time_weeks;
    double weights = 0.0, values = 0.0, squares = 0.0;
    for (const Point& point : points) {
        const double weight = weight_of(point, scatter), value = point.value - origin;
        weights += weight;
        values += weight * value;
        squares += weight * value * value;
    }
    const Unchanged unchanged{std::max(0.0, squares - values * values / weights),
                              static_cast<double>(points.size()) - 1.0};
    double w = 0.0, wy = 0.0, wt = 0.0, wtt = 0.0, wty = 0.0;
    for (std::size_t k = points.size() - 1; k > 0; --k) {
        const double weight = weight_of(points[k], scatter), value = points[k].value - origin;
        const double time = points[k].time_weeks - end_weeks;
        w += weight;
        wy += weight * value;
        wt += weight * time;
        wtt += weight * time * time;
        wty += weight * time * value;
        const ColumnFit step{w - w * w / weights, wy - w * values / weights};
        const LogRatio of_step = log_ratio(step, unchanged, scatter.degrees, step_laws);
        result.set(ChangeKind::step, k, of_step.mean, of_step.best);
        const double since = points[k - 1].time_weeks - end_weeks;
        const double wr = wt - since * w, wrr = wtt - 2.0 * since * wt + since * since * w;
        const double wry = wty - since * wy;
        const ColumnFit trend{wrr - wr * wr / weights, wry - wr * values / weights};
        const LogRatio of_trend = log_ratio(trend, unchanged, scatter.degrees, trend_laws);
        result.set(ChangeKind::trend, k, of_trend.mean, of_trend.best);
    }
    return result;
}

Eigen::VectorXd roots_of_weights(std::span<const Point> points, const Scatter& scatter) {
    Eigen::VectorXd roots(static_cast<Eigen::Index>(points.size()));
    for (Eigen::Index i = 0; i < roots.size(); ++i)
        roots(i) = std::sqrt(weight_of(points[static_cast<std::size_t>(i)], scatter));
    return roots;
}

Eigen::VectorXd over(std::span<const Point> points, const ChangeColumn& column) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(points.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i)
        values(i) = column.at(points[static_cast<std::size_t>(i)].time_weeks);
    return values;
}

Eigen::VectorXd values_of(std::span<const Point> points) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(points.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) values(i) = points[static_cast<std::size_t>(i)].value;
    return values;
}

/// Orthonormal columns that span a level and changes, weighted; those that add nothing are left out.
Eigen::MatrixXd basis_of(std::span<const Point> points, const Eigen::VectorXd& roots,
                         std::span<const ChangeColumn> known) {
    constexpr double nothing = 1e-9;
    Eigen::MatrixXd basis(roots.size(), 1);
    basis.col(0) = roots.normalized();
    for (const ChangeColumn& column : known) {
        Eigen::VectorXd next = roots.cwiseProduct(over(points, column));
        const double before = next.norm();
        for (int again = 0; again < 2; ++again) next -= basis * (basis.transpose() * next);
        if (!(next.norm() > nothing * before)) continue;
        basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
        basis.col(basis.cols() - 1) = next.normalized();
    }
    return basis;
}

std::vector<Point> as_normals(std::span<const Point> points) {
    std::vector<Point> normals;
    for (const Point& point : points) normals.push_back(as_normal(point));
    return normals;
}

/// The first point after a begin that has a known step that the begin has not.
std::size_t end_of_stretch(std::span<const Point> points, std::size_t begin,
                           std::span<const ChangeColumn> steps) {
    const auto steps_at = [&](std::size_t t) {
        return std::ranges::count_if(
            steps, [&](const ChangeColumn& step) { return step.since_weeks <= points[t].time_weeks; });
    };
    std::size_t end = begin + 1;
    while (end < points.size() && steps_at(end) == steps_at(begin)) ++end;
    return end;
}

}  // namespace

ChangeColumn column_of(ChangeKind kind, std::span<const Point> points, std::size_t first) {
    FIDSERVO_DEMAND(first > 0 && first < points.size());
    return {kind, points[kind == ChangeKind::step ? first : first - 1].time_weeks};
}

double ChangeScan::log_sum() const {
    const std::array<double, 2> kinds{log_weight(ChangeKind::step), log_weight(ChangeKind::trend)};
    return log_of_sum(kinds) - std::log(2.0);
}

double ChangeScan::log_weight(ChangeKind kind) const {
    return log_of_sum(kind == ChangeKind::step ? step_ : trend_);
}

ChangeDates ChangeScan::dates(ChangeKind kind) const {
    constexpr double within = 0.95;
    const std::vector<double>& weights = kind == ChangeKind::step ? step_ : trend_;
    const std::vector<double>& best = kind == ChangeKind::step ? step_best_ : trend_best_;
    const auto likeliest = static_cast<std::size_t>(std::ranges::max_element(best) - best.begin());
    std::vector<std::size_t> order(weights.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t k) { return weights[k]; });
    const double all = log_of_sum(weights);
    ChangeDates dates{likeliest, likeliest, likeliest};
    double sum = 0.0;
    for (const std::size_t k : order) {
        if (sum >= within) break;
        sum += std::exp(weights[k] - all);
        dates.earliest = std::min(dates.earliest, k);
        dates.latest = std::max(dates.latest, k);
    }
    return dates;
}

ChangeScan::StepWithin ChangeScan::step_within(std::size_t first, std::size_t last) const {
    const std::span<const double> ratios = std::span(step_).subspan(first, last - first + 1);
    const std::span<const double> best = std::span(step_best_).subspan(first, last - first + 1);
    return {log_of_sum(ratios) - std::log(static_cast<double>(ratios.size())),
            first + static_cast<std::size_t>(std::ranges::max_element(best) - best.begin())};
}

void ChangeScan::set_from(std::size_t begin, const ChangeScan& stretch) {
    for (std::size_t k = 1; k < stretch.step_.size(); ++k) {
        set(ChangeKind::step, begin + k, stretch.step_[k], stretch.step_best_[k]);
        set(ChangeKind::trend, begin + k, stretch.trend_[k], stretch.trend_best_[k]);
    }
}

void ChangeScan::set(ChangeKind kind, std::size_t first, double log_ratio, double log_best) {
    (kind == ChangeKind::step ? step_ : trend_)[first] = log_ratio;
    (kind == ChangeKind::step ? step_best_ : trend_best_)[first] = log_best;
}

std::span<const double> laws_of(ChangeKind kind) {
    return kind == ChangeKind::step ? std::span<const double>(step_laws) : trend_laws;
}

ChangeScan scan_as_normal(std::span<const Point> all, const Scatter& scatter,
                          std::span<const ChangeColumn> known) {
    const std::vector<Point> points = as_normals(all);
    if (known.empty()) return scan_beside_level(points, scatter);
    ChangeScan result(points.size());
    const Eigen::VectorXd roots = roots_of_weights(points, scatter);
    const Eigen::MatrixXd basis = basis_of(points, roots, known);
    const auto beside = [&](Eigen::VectorXd column) -> Eigen::VectorXd {
        return column - basis * (basis.transpose() * column);
    };
    const Eigen::VectorXd left = beside(roots.cwiseProduct(values_of(points)));
    const Unchanged unchanged{left.squaredNorm(),
                              static_cast<double>(points.size()) - static_cast<double>(basis.cols())};
    for (std::size_t k = 1; k < points.size(); ++k) {
        const auto ratio_of = [&](ChangeKind kind, const auto& laws) {
            const Eigen::VectorXd column =
                beside(roots.cwiseProduct(over(points, column_of(kind, points, k))));
            const LogRatio ratio =
                log_ratio({column.squaredNorm(), column.dot(left)}, unchanged, scatter.degrees, laws);
            result.set(kind, k, ratio.mean, ratio.best);
        };
        ratio_of(ChangeKind::step, step_laws);
        ratio_of(ChangeKind::trend, trend_laws);
    }
    return result;
}

ChangeScan scan(std::span<const Point> points, const Scatter& scatter, std::span<const ChangeColumn> known) {
    const auto is_trend = [](const ChangeColumn& column) { return column.kind == ChangeKind::trend; };
    if (std::ranges::all_of(points, &Point::named) || scatter.degrees == 0.0 ||
        std::ranges::any_of(known, is_trend))
        return scan_as_normal(points, scatter, known);
    // Between known steps the level is any: each stretch is by itself.
    ChangeScan result(points.size());
    for (std::size_t begin = 0; begin < points.size();) {
        const std::size_t end = end_of_stretch(points, begin, known);
        if (begin > 0)
            for (const ChangeKind kind : {ChangeKind::step, ChangeKind::trend})
                result.set(kind, begin, 0.0, 0.0);
        const std::span<const Point> stretch = points.subspan(begin, end - begin);
        result.set_from(begin, std::ranges::all_of(stretch, &Point::named)
                                   ? scan_as_normal(stretch, scatter, {})
                                   : scan_with_limits(stretch, scatter));
        begin = end;
    }
    return result;
}

Level size_of(std::span<const Point> all, const Scatter& scatter, std::span<const ChangeColumn> others,
              const ChangeColumn& change) {
    const std::vector<Point> points = as_normals(all);
    const Eigen::VectorXd roots = roots_of_weights(points, scatter);
    const Eigen::MatrixXd basis = basis_of(points, roots, others);
    Eigen::VectorXd column = roots.cwiseProduct(over(points, change));
    column -= basis * (basis.transpose() * column);
    const double square = column.squaredNorm();
    if (!(square > 0.0)) return {};
    return {column.dot(roots.cwiseProduct(values_of(points))) / square, 1.0 / std::sqrt(square)};
}

Level value_at(std::span<const Point> all, const Scatter& scatter, std::span<const ChangeColumn> changes,
               double time_weeks) {
    const std::vector<Point> points = as_normals(all);
    const Eigen::VectorXd roots = roots_of_weights(points, scatter);
    const auto columns = static_cast<Eigen::Index>(changes.size());
    Eigen::MatrixXd design(roots.size(), columns + 1);
    Eigen::VectorXd now(columns + 1);
    design.col(0) = roots;
    now(0) = 1.0;
    for (Eigen::Index c = 0; c < columns; ++c) {
        const ChangeColumn& change = changes[static_cast<std::size_t>(c)];
        design.col(c + 1) = roots.cwiseProduct(over(points, change));
        now(c + 1) = change.at(time_weeks);
    }
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(design.transpose() * design);
    const Eigen::VectorXd sizes = solver.solve(design.transpose() * roots.cwiseProduct(values_of(points)));
    return {now.dot(sizes), std::sqrt(std::max(0.0, now.dot(solver.solve(now))))};
}

}  // namespace fidservo::fleet
