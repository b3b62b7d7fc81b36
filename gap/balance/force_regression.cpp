// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/force_regression.h"

#include "core/median.h"
#include "core/parallel.h"
#include "core/rig.h"
#include "gap/balance/balance_fit.h"
#include "gap/balance/period_search.h"
#include "gap/candidates/coupling.h"
#include "gap/candidates/wave.h"
#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

/// Share of a typical size at which errors are still proportional to it.
constexpr double small_share = 0.1;

constexpr std::size_t most_balanced = 6;

/// Share of a column's own square, against columns that are nearly collinear.
constexpr double column_ridge = 1e-6;

/// The longer supports see weaker forces.
constexpr std::size_t balanced_half_support = long_half_support;

/// A candidate of which only sizes are unknown; of a wave its sine and cosine are.
struct ForceGroup {
    const Candidate* candidate;
    std::vector<double> values;  ///< without the sizes
    std::vector<plant::EffectSetting> units;
    Eigen::Index first = 0;  ///< of its columns

    Eigen::Index columns() const { return static_cast<Eigen::Index>(units.size()); }

    /// At multiples of its units.
    plant::EffectSetting at(const Eigen::VectorXd& multiples) const {
        plant::EffectSetting setting{candidate->effect, values};
        if (candidate->wave) {
            setting.values[candidate->wave->amplitude] *= multiples.norm();
            setting.values[candidate->wave->phase] = std::atan2(multiples(1), multiples(0));
            return setting;
        }
        for (std::size_t u = 0; u < units.size(); ++u)
            for (std::size_t k = 0; k < values.size(); ++k)
                setting.values[k] +=
                    multiples(static_cast<Eigen::Index>(u)) * (units[u].values[k] - values[k]);
        return setting;
    }
};

Hypothesis within_bounds(Hypothesis settings) {
    for (plant::EffectSetting& setting : settings)
        for (std::size_t k = 0; k < setting.values.size(); ++k) {
            const plant::EffectParameter& parameter = setting.effect->parameters[k];
            setting.values[k] = std::clamp(setting.values[k], parameter.low, parameter.high);
        }
    return settings;
}

ForceGroup group_of(const Candidate& candidate, const std::vector<double>& shape,
                    std::span<const std::size_t> sizes) {
    ForceGroup group{&candidate, shape, {}};
    for (const std::size_t size : candidate.sizes)
        group.values[size] = candidate.effect->parameters[size].vanishing;
    for (const std::size_t size : sizes) {
        group.units.push_back({candidate.effect, group.values});
        group.units.back().values[size] += small_share * (shape[size] - group.values[size]);
    }
    return group;
}

ForceGroup group_of(const Candidate& wave, double period_mm) {
    ForceGroup group{&wave, wave.shapes.front(), {}};
    group.values[wave.wave->period] = period_mm;
    for (const double phase_rad : {0.0, 0.5 * std::numbers::pi}) {
        group.units.push_back({wave.effect, group.values});
        group.units.back().values[wave.wave->phase] = phase_rad;
    }
    return group;
}

/// Neighbouring periods are two fifths of a turn apart over the whole way, or as many as can be tried over a
/// longer one.
std::vector<double> periods_over(double way_mm) {
    constexpr double turns_apart = 0.4, most_periods = 300.0;
    constexpr double least_per_mm = 1.0 / longest_period_mm, most_per_mm = 1.0 / shortest_wave_mm;
    const double step_per_mm = std::max(turns_apart / way_mm, (most_per_mm - least_per_mm) / most_periods);
    std::vector<double> periods_mm;
    for (double per_mm = least_per_mm; per_mm < most_per_mm; per_mm += step_per_mm)
        periods_mm.push_back(1.0 / per_mm);
    return periods_mm;
}

std::vector<ForceGroup> groups_of(const Rig& rig, std::span<const Candidate* const> candidates,
                                  double way_mm) {
    std::vector<ForceGroup> groups;
    for (const Candidate* candidate : candidates) {
        if (!is_force(rig, *candidate)) continue;
        if (candidate->wave) {
            for (const double period_mm : periods_over(way_mm))
                groups.push_back(group_of(*candidate, period_mm));
            continue;
        }
        for (const std::vector<double>& shape : candidate->shapes) {
            groups.push_back(group_of(*candidate, shape, candidate->sizes));
            if (candidate->sizes.size() < 2) continue;
            for (const std::size_t size : candidate->sizes)
                groups.push_back(group_of(*candidate, shape, std::array{size}));
        }
    }
    Eigen::Index first = 0;
    for (ForceGroup& group : groups) {
        group.first = first;
        first += group.columns();
    }
    return groups;
}

/// What all groups do to the balance of every support, and what is in excess there, of the opposite sign.
class Columns {
  public:
    Columns(const ForceBalance& balance, const Hypothesis& base, std::span<const ForceGroup> groups,
            std::span<const std::uint8_t> halves)
        : windows_count_(balance.windows().size()) {
        std::vector<const plant::EffectSetting*> units;
        for (const ForceGroup& group : groups)
            for (const plant::EffectSetting& unit : group.units) units.push_back(&unit);
        const Errors excess = balance.excess(base);
        const auto rows = static_cast<Eigen::Index>(balance.supports());
        values_.resize(rows, static_cast<Eigen::Index>(units.size()));
        excess_.resize(rows);
        for (Eigen::Index i = 0; i < rows; ++i)
            excess_(i) = -static_cast<double>(excess[static_cast<std::size_t>(i)]);
        parallel_for(units.size(), [&](std::size_t unit) {
            Hypothesis whole = base;
            whole.push_back(*units[unit]);
            const Errors with = balance.excess(whole);
            for (Eigen::Index i = 0; i < rows; ++i)
                values_(i, static_cast<Eigen::Index>(unit)) =
                    static_cast<double>(with[static_cast<std::size_t>(i)]) + excess_(i);
        });
        find_windows(balance.windows(), halves);
        left_ = excess_;
        weigh();
    }

    /// Squares that each group takes away beside the columns that are in.
    std::vector<double> taken_by(std::span<const ForceGroup> groups, std::span<const Eigen::Index> in) const {
        const Eigen::MatrixXd weighted = weights_.asDiagonal() * values_;
        Eigen::MatrixXd basis(values_.rows(), 0);
        if (!in.empty()) {
            const Eigen::MatrixXd chosen = weighted(Eigen::all, in);
            basis = Eigen::HouseholderQR<Eigen::MatrixXd>(chosen).householderQ() *
                    Eigen::MatrixXd::Identity(chosen.rows(), chosen.cols());
        }
        Eigen::VectorXd rest = weights_.asDiagonal() * excess_;
        rest -= basis * (basis.transpose() * rest);
        const Eigen::MatrixXd shared = basis.transpose() * weighted;
        std::vector<double> taken(groups.size(), 0.0);
        parallel_for(groups.size(), [&](std::size_t g) {
            const ForceGroup& group = groups[g];
            const auto own = weighted.middleCols(group.first, group.columns());
            const auto known = shared.middleCols(group.first, group.columns());
            const Eigen::MatrixXd whole = own.transpose() * own;
            Eigen::MatrixXd normal = whole - known.transpose() * known;
            normal.diagonal() += column_ridge * whole.diagonal();
            if (normal.diagonal().minCoeff() <= 0.0) return;
            const Eigen::VectorXd right = own.transpose() * rest;
            taken[g] = right.dot(normal.ldlt().solve(right));
        });
        return taken;
    }

    /// Multiples of some columns that leave least of the supports of one half, or of all.
    Eigen::VectorXd solve(std::span<const Eigen::Index> in, std::optional<std::uint8_t> half) const {
        Eigen::VectorXd weights = weights_;
        for (Eigen::Index i = 0; half && i < weights.size(); ++i)
            if (half_of_[static_cast<std::size_t>(i)] != *half) weights(i) = 0.0;
        const Eigen::MatrixXd chosen = weights.asDiagonal() * values_(Eigen::all, in);
        Eigen::MatrixXd normal = chosen.transpose() * chosen;
        for (Eigen::Index k = 0; k < normal.rows(); ++k)
            normal(k, k) += column_ridge * normal(k, k) + std::numeric_limits<double>::min();
        return normal.ldlt().solve(chosen.transpose() * (weights.asDiagonal() * excess_));
    }

    /// Mean squares of windows, in those of the noise, predicted by what the other half teaches.
    std::vector<double> held_out_squares(std::span<const Eigen::Index> in) const {
        std::vector<double> squares(windows_count_, 0.0), count = squares;
        for (std::uint8_t half = 0; half < 2; ++half) {
            Eigen::VectorXd left = excess_;
            if (!in.empty()) left -= values_(Eigen::all, in) * solve(in, static_cast<std::uint8_t>(1 - half));
            for (Eigen::Index i = 0; i < left.size(); ++i) {
                if (half_of_[static_cast<std::size_t>(i)] != half) continue;
                const std::size_t window = window_of_[static_cast<std::size_t>(i)];
                squares[window] += left(i) * left(i) / (noise_ * noise_);
                count[window] += 1.0;
            }
        }
        for (std::size_t w = 0; w < squares.size(); ++w) squares[w] /= count[w];
        return squares;
    }

    /// Logarithm of how many times likelier windows are of some squares than of other ones, as many values in
    /// each as supports that do not overlap.
    double gain(std::span<const double> without, std::span<const double> with) const {
        constexpr double apart = 0.5 * static_cast<double>(balanced_half_support);
        constexpr double share = apart / static_cast<double>(2 * balanced_half_support + 1);
        double gain = 0.0;
        for (const std::size_t window : window_of_)
            gain += share * (window_loss(without[window]) - window_loss(with[window]));
        return gain;
    }

    /// Weights supports by what some columns leave.
    void weigh_beside(std::span<const Eigen::Index> in) {
        left_ = excess_ - values_(Eigen::all, in) * solve(in, std::nullopt);
        weigh();
    }

  private:
    void find_windows(std::span<const Window> windows, std::span<const std::uint8_t> halves) {
        for (std::size_t window = 0; window < windows.size(); ++window) {
            window_of_.resize(windows[window].end, window);
            half_of_.resize(windows[window].end, halves[window]);
        }
    }

    void weigh() {
        constexpr double deviations_of_median = 1.0 / 0.6745, as_usual = 2.0;
        std::vector<double> sizes(left_.data(), left_.data() + left_.size());
        for (double& size : sizes) size = std::abs(size);
        const double scale = as_usual * std::max(noise_, deviations_of_median * median_of(std::move(sizes)));
        weights_ = (1.0 + (left_ / scale).array().square()).rsqrt();
    }

    /// Standard deviation of an excess.
    static constexpr double noise_ = 1.0 / ForceBalance::deviations;

    std::size_t windows_count_;
    std::vector<std::size_t> window_of_;  ///< each support
    std::vector<std::uint8_t> half_of_;
    Eigen::MatrixXd values_;
    Eigen::VectorXd excess_, left_, weights_;
};

/// Groups that were taken in.
struct Taken {
    std::vector<const ForceGroup*> groups;
    std::vector<Eigen::Index> columns;

    Taken with(const ForceGroup& group) const {
        Taken more = *this;
        more.groups.push_back(&group);
        for (Eigen::Index k = 0; k < group.columns(); ++k) more.columns.push_back(group.first + k);
        return more;
    }

    bool has(const Candidate& candidate) const {
        return std::ranges::any_of(groups, [&](const ForceGroup* group) {
            return group->candidate->class_name == candidate.class_name;
        });
    }
};

Hypothesis settings_of(const Taken& taken, const Eigen::VectorXd& multiples) {
    Hypothesis settings;
    Eigen::Index at = 0;
    for (const ForceGroup* group : taken.groups) {
        settings.push_back(group->at(multiples.segment(at, group->columns())));
        at += group->columns();
    }
    return settings;
}

/// With the group that takes most and that no bound forbids; nothing if that is none.
std::optional<Taken> with_next(const Columns& columns, std::span<const ForceGroup> groups,
                               const Taken& taken) {
    constexpr std::size_t most_tried = 20;
    const std::vector<double> gains = columns.taken_by(groups, taken.columns);
    std::vector<std::size_t> order(groups.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t g) { return taken.has(*groups[g].candidate); });
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t g) { return gains[g]; });
    if (order.size() > most_tried) order.resize(most_tried);
    for (const std::size_t g : order) {
        Taken more = taken.with(groups[g]);
        const Hypothesis settings = settings_of(more, columns.solve(more.columns, std::nullopt));
        if (within_bounds(settings) == settings) return more;
    }
    return {};
}

}  // namespace

bool is_force(const Rig& rig, const Candidate& candidate) {
    const plant::Effect& effect = *candidate.effect;
    if (!shows_in_balance(effect)) return false;
    const plant::PlantParameters nominal = plant::plant_parameters(rig);
    plant::PlantParameters parameters = nominal;
    plant::put(effect, parameters, plant::typical_setting(effect).values);
    return parameters.axis.delay_s == nominal.axis.delay_s &&
           parameters.axis.belt.compliance_mm_per_V == nominal.axis.belt.compliance_mm_per_V &&
           parameters.encoder.resolution_mm == nominal.encoder.resolution_mm;
}

std::vector<BalancedModel> balanced_models(const Evidence& evidence, std::span<const std::uint8_t> halves,
                                           const Hypothesis& base,
                                           std::span<const Candidate* const> candidates, double tail) {
    const std::vector<Window>& windows = evidence.windows();
    const Wanted wanted = only_of(windows, everything(evidence), only(Signal::encoder));
    const ForceBalance balance(evidence, wanted, base, balanced_half_support);
    if (balance.supports() == 0) return {};
    std::vector<const Candidate*> unknown(candidates.begin(), candidates.end());
    std::erase_if(unknown, [&](const Candidate* candidate) { return has_effect(base, *candidate->effect); });
    const std::vector<ForceGroup> groups = groups_of(evidence.rig(), unknown, balance.way_mm());
    Columns columns(balance, base, groups, halves);
    Wanted first_half = wanted;
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (halves[w] != 0) first_half[w] = 0;
    const BalanceFit balanced(balance, first_half, base);
    std::vector<BalancedModel> models;
    Taken taken;
    std::vector<double> squares = columns.held_out_squares({});
    while (taken.groups.size() < most_balanced) {
        std::optional<Taken> more = with_next(columns, groups, taken);
        if (!more) break;
        columns.weigh_beside(more->columns);
        std::vector<double> with = columns.held_out_squares(more->columns);
        if (columns.gain(squares, with) < std::log(static_cast<double>(groups.size()) / tail)) break;
        taken = *std::move(more);
        squares = std::move(with);
        BalancedModel model;
        for (const ForceGroup* group : taken.groups) model.candidates.push_back(group->candidate);
        const Hypothesis start = settings_of(taken, columns.solve(taken.columns, std::nullopt));
        model.settings = balanced.fit(within_bounds(start)).hypothesis;
        models.push_back(std::move(model));
    }
    return models;
}

}  // namespace fidservo::gap
