// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/period_search.h"

#include "core/parallel.h"
#include "gap/balance/carriage_forces.h"
#include "gap/balance/rail_stretch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <span>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

constexpr double shortest_period_mm = 0.8;

/// What the supports of one window lack, and where they begin in the rows.
struct Lacking {
    std::vector<std::size_t> first;
    Eigen::VectorXd of_support;
    double weight = 0.0;
};

std::vector<Lacking> by_window(const CarriageForces& forces, const RailStretch& places) {
    std::vector<Lacking> all;
    std::vector<double> values;
    const auto close = [&] {
        if (values.empty()) return;
        Lacking& last = all.back();
        last.of_support = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
        last.weight = 1.0 / (static_cast<double>(values.size()) + last.of_support.squaredNorm());
        values.clear();
    };
    std::size_t w = 0, of_last = forces.windows().size();
    for (std::size_t k = 0; k < forces.supports().size(); ++k) {
        const std::size_t first = forces.supports()[k], last = first + forces.force_weights().size() - 1;
        if (!places.holds(forces.rows()[first]) || !places.holds(forces.rows()[last])) continue;
        while (k >= forces.windows()[w].end) ++w;
        if (w != of_last) {
            close();
            all.emplace_back();
            of_last = w;
        }
        all.back().first.push_back(first);
        values.push_back(forces.lacking()[k]);
    }
    close();
    return all;
}

/// Cosine and sine of the rows' places.
class Waves {
  public:
    Waves(std::span<const SlidingRow> rows, const RailStretch& places)
        : rows_(rows),
          places_(places),
          cosine_(rows.size()),
          sine_(rows.size()),
          passed_cosine_(rows.size()),
          passed_sine_(rows.size()) {}

    void set(double per_mm) {
        const auto wave_number = static_cast<float>(2.0 * std::numbers::pi * per_mm);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (!places_.holds(rows_[k])) continue;
            const float angle = wave_number * static_cast<float>(rows_[k].position_mm);
            const auto passed = static_cast<float>(rows_[k].passed);
            cosine_[k] = std::cos(angle);
            sine_[k] = std::sin(angle);
            passed_cosine_[k] = passed * cosine_[k];
            passed_sine_[k] = passed * sine_[k];
        }
    }

    /// Cosine and sine as readings and as forces, over a support.
    Eigen::RowVector4d over(std::size_t first, const Eigen::VectorXf& reading_weights,
                            const Eigen::VectorXf& force_weights) const {
        const auto sum = [&](const Eigen::VectorXf& weights, const std::vector<float>& values) {
            return weights.dot(Eigen::Map<const Eigen::VectorXf>(&values[first], weights.size()));
        };
        return {sum(reading_weights, cosine_), sum(reading_weights, sine_),
                sum(force_weights, passed_cosine_), sum(force_weights, passed_sine_)};
    }

  private:
    std::span<const SlidingRow> rows_;
    RailStretch places_;  ///< rows beside these are in no support
    std::vector<float> cosine_, sine_;
    std::vector<float> passed_cosine_, passed_sine_;  ///< behind the dead zone
};

/// The wave whose lack leaves errors of these shares of cosine and sine.
Wave wave_from(const Eigen::Vector2d& cosine_sine) {
    return {cosine_sine.norm(), std::atan2(-cosine_sine.x(), -cosine_sine.y())};
}

class Periodogram {
  public:
    Periodogram(const Evidence& evidence, const CarriageForces& forces, const RailStretch& places)
        : evidence_(evidence),
          windows_(by_window(forces, places)),
          reading_weights_(in_floats(forces.reading_weights())),
          force_weights_(in_floats(forces.force_weights())),
          half_support_(forces.force_weights().size() / 2),
          waves_(forces.rows(), places) {
        for (const Lacking& window : windows_) squares_ += window.weight * window.of_support.squaredNorm();
    }

    PositionPeriod at(double per_mm) {
        evidence_.budget()->check();
        waves_.set(per_mm);
        Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
        Eigen::Vector4d right = Eigen::Vector4d::Zero();
        for (const Lacking& window : windows_) {
            Eigen::Matrix<double, Eigen::Dynamic, 4> columns(std::ssize(window.first), matrix.cols());
            for (std::size_t k = 0; k < window.first.size(); ++k)
                columns.row(static_cast<Eigen::Index>(k)) =
                    waves_.over(window.first[k], reading_weights_, force_weights_);
            matrix += window.weight * columns.transpose() * columns;
            right += window.weight * columns.transpose() * window.of_support;
        }
        const Eigen::Vector4d found = matrix.completeOrthogonalDecomposition().solve(right);
        return {1.0 / per_mm, found.dot(right) / squares_, half_support_, wave_from(found.tail<2>()),
                wave_from(found.head<2>())};
    }

    /// The highest place within a step to each side, by thirds.
    PositionPeriod climbed(PositionPeriod from, double step_per_mm) {
        constexpr int rounds = 12;
        constexpr double narrower = 2.0 / 3.0;
        for (int round = 0; round < rounds; ++round, step_per_mm *= narrower)
            for (const double side : {-0.5, 0.5}) {
                const PositionPeriod there = at(1.0 / from.period_mm + side * step_per_mm);
                if (there.share <= from.share) continue;
                from = there;
                break;
            }
        return from;
    }

  private:
    static Eigen::VectorXf in_floats(const std::vector<double>& weights) {
        return Eigen::Map<const Eigen::VectorXd>(weights.data(), std::ssize(weights)).cast<float>();
    }

    const Evidence& evidence_;
    std::vector<Lacking> windows_;
    Eigen::VectorXf reading_weights_, force_weights_;
    std::size_t half_support_;
    Waves waves_;
    double squares_ = 0.0;
};

/// The highest of a periodogram, none beside a higher one.
std::vector<PositionPeriod> peaks(std::span<const PositionPeriod> all) {
    constexpr std::size_t apart = 3;
    std::vector<std::size_t> order(all.size()), chosen;
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, std::greater{}, [&](std::size_t k) { return all[k].share; });
    for (const std::size_t k : order) {
        const bool is_beside = std::ranges::any_of(
            chosen, [&](std::size_t other) { return k < other + apart && other < k + apart; });
        if (!is_beside && chosen.size() < most_peaks) chosen.push_back(k);
    }
    std::vector<PositionPeriod> found;
    found.reserve(chosen.size());
    for (const std::size_t k : chosen) found.push_back(all[k]);
    return found;
}

/// @param half_support  gap/balance/carriage_forces.h
std::vector<PositionPeriod> strongest_periods(const Evidence& evidence, const Errors& errors,
                                              std::size_t half_support) {
    const CarriageForces forces(evidence, errors, half_support);
    if (forces.supports().empty()) return {};
    const RailStretch places = most_visited(forces.rows());
    const double range_mm = places.length_mm();
    if (range_mm < 2.0 * shortest_period_mm) return {};
    Periodogram periodogram(evidence, forces, places);
    const double step_per_mm = 0.5 / range_mm;
    std::vector<PositionPeriod> all;
    for (double per_mm = 1.0 / std::min(longest_period_mm, range_mm); per_mm <= 1.0 / shortest_period_mm;
         per_mm += step_per_mm)
        all.push_back(periodogram.at(per_mm));
    std::vector<PositionPeriod> strongest = peaks(all);
    for (PositionPeriod& period : strongest) period = periodogram.climbed(period, step_per_mm);
    return strongest;
}

}  // namespace

std::vector<PositionPeriod> strongest_periods(const Evidence& evidence, const Errors& errors) {
    constexpr std::array half_supports{short_half_support, long_half_support};
    std::array<std::vector<PositionPeriod>, half_supports.size()> of_support;
    parallel_for(half_supports.size(), [&](std::size_t k) {
        of_support[k] = strongest_periods(evidence, errors, half_supports[k]);
    });
    std::vector<PositionPeriod> all;
    for (const std::vector<PositionPeriod>& some : of_support)
        std::ranges::copy(some, std::back_inserter(all));
    std::ranges::sort(all, std::greater{}, &PositionPeriod::share);
    return all;
}

}  // namespace fidservo::gap
