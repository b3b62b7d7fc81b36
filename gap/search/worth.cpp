// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/worth.h"

#include "gap/candidates/coupling.h"
#include "gap/fit/minimum_norm.h"
#include "gap/fit/predictive_density.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace fidservo::gap {
namespace {

/// The sizes of some candidates that were fitted together, in standard deviations of all parameters, and
/// their correlations where the shapes keep their values: an effect of size zero has no shape that could make
/// up for it.
class Sizes {
  public:
    Sizes(std::span<const Candidate* const> candidates, const Fit& fitted) : at_(candidates.size()) {
        std::vector<double> all;
        std::vector<Eigen::Index> shapes;
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            const plant::EffectSetting& setting = fitted.hypothesis[c];
            for (std::size_t k = 0; k < setting.values.size(); ++k) {
                const plant::EffectParameter& parameter = setting.effect->parameters[k];
                const bool is_size = std::ranges::find(candidates[c]->sizes, k) != candidates[c]->sizes.end();
                (is_size ? at_[c] : shapes).push_back(static_cast<Eigen::Index>(all.size()));
                all.push_back(setting.values[k] - parameter.vanishing);
            }
        }
        const Eigen::VectorXd deviations = fitted.curvature_covariance.diagonal().cwiseSqrt();
        const Eigen::VectorXd per_deviation =
            (deviations.array() > 0.0).select(deviations.cwiseInverse(), 0.0);
        sizes_ = Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()))
                     .cwiseProduct(per_deviation);
        correlations_ = per_deviation.asDiagonal() * fitted.curvature_covariance * per_deviation.asDiagonal();
        if (shapes.empty()) return;
        const Eigen::MatrixXd with_shapes = correlations_(Eigen::all, shapes);
        correlations_ -=
            with_shapes * minimum_norm_solutions(correlations_(shapes, shapes), with_shapes.transpose());
    }

    /// Loss that some candidates together save beside the others.
    double worth(const std::vector<std::size_t>& left_out) const {
        std::vector<Eigen::Index> places;
        for (const std::size_t c : left_out) places.insert(places.end(), at_[c].begin(), at_[c].end());
        const Eigen::VectorXd sizes = sizes_(places);
        const Eigen::MatrixXd own = correlations_(places, places);
        return 0.5 * sizes.dot(minimum_norm_solution(own, sizes));
    }

  private:
    std::vector<std::vector<Eigen::Index>> at_;  ///< each candidate's sizes among all parameters
    Eigen::VectorXd sizes_;                      ///< of all parameters
    Eigen::MatrixXd correlations_;
};

/// Whether an effect has no size and a bound keeps it from having one of the other sign.
bool is_held(const plant::EffectSetting& setting) {
    const std::span<const plant::EffectParameter> parameters = setting.effect->parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        const double value = setting.values[k];
        const bool is_at_bound = value <= parameters[k].low || value >= parameters[k].high;
        if (parameters[k].is_size() && (value != parameters[k].vanishing || !is_at_bound)) return false;
    }
    return true;
}

}  // namespace

Demand::Demand(const Evidence& evidence, const Wanted& wanted, const Errors& errors) : Demand() {
    const std::vector<Window>& windows = evidence.windows();
    std::vector<double> squares = mean_squares(windows, errors);
    std::array<std::set<std::size_t>, signal_count> runs;
    std::array<double, signal_count> count{}, expected{};
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (wanted[w] == 0) squares[w] = std::numeric_limits<double>::quiet_NaN();
        if (std::isnan(squares[w])) continue;
        const std::size_t signal = index_of(windows[w].signal);
        runs[signal].insert(windows[w].run);
        count[signal] += 1.0;
        expected[signal] += windows[w].expected_square;
    }
    const Discrepancy left = discrepancy_of(windows, squares);
    for (std::size_t s = 0; s < signal_count; ++s)
        if (count[s] > 0.0)
            times_[s] = 1.0 / independent_share(count[s] / static_cast<double>(runs[s].size()),
                                                expected[s] / count[s], left[s]);
}

double Demand::worth_of(const Candidate& candidate) const {
    const SignalFlags teachers = teachers_of(*candidate.effect);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < signal_count; ++s)
        if (teachers[s]) least = std::min(least, times_[s]);
    return least_worth * (std::isfinite(least) ? least : 1.0);
}

std::vector<std::size_t> kept(std::span<const Candidate* const> candidates, const Fit& fitted,
                              const Demand& demand, bool spares_held) {
    const Sizes sizes(candidates, fitted);
    std::vector<std::size_t> rest(candidates.size()), left_out;
    for (std::size_t c = 0; c < rest.size(); ++c) rest[c] = c;
    double lost = 0.0;
    while (!rest.empty()) {
        double least = std::numeric_limits<double>::infinity(), lost_with_it = lost;
        std::size_t at = 0;
        for (std::size_t k = 0; k < rest.size(); ++k) {
            std::vector<std::size_t> without = left_out;
            without.push_back(rest[k]);
            const double worth = sizes.worth(without);
            const double share = (worth - lost) / demand.worth_of(*candidates[rest[k]]);
            if (share < least && !(spares_held && is_held(fitted.hypothesis[rest[k]]))) {
                least = share;
                lost_with_it = worth;
                at = k;
            }
        }
        if (least >= 1.0) break;
        lost = std::max(lost, lost_with_it);
        left_out.push_back(rest[at]);
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
    }
    return rest;
}

std::vector<double> worth_of_each(std::span<const Candidate* const> candidates, const Fit& fitted) {
    const Sizes sizes(candidates, fitted);
    std::vector<double> worth;
    for (std::size_t c = 0; c < candidates.size(); ++c) worth.push_back(sizes.worth({c}));
    return worth;
}

}  // namespace fidservo::gap
