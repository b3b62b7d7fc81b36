// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/search/worth.h"

#include "gap/candidates/coupling.h"
#include "gap/fit/minimum_norm.h"
#include "gap/fit/predictive_density.h"
#include "gap/fit/score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace fidservo::gap {
namespace {

using Indices = std::vector<Eigen::Index>;

/// The sizes of some candidates that were fitted together, in standard deviations of all parameters, and the
/// correlations of these.
class Sizes {
  public:
    Sizes(std::span<const Candidate* const> candidates, const Fit& fitted) : of_(candidates.size()) {
        std::vector<double> all;
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            const plant::EffectSetting& setting = fitted.hypothesis[c];
            for (std::size_t k = 0; k < setting.values.size(); ++k) {
                const plant::EffectParameter& parameter = setting.effect->parameters[k];
                const bool is_size = std::ranges::find(candidates[c]->sizes, k) != candidates[c]->sizes.end();
                (is_size ? of_[c].sizes : of_[c].shapes).push_back(static_cast<Eigen::Index>(all.size()));
                all.push_back(setting.values[k] - parameter.vanishing);
            }
        }
        const Eigen::VectorXd deviations = fitted.curvature_covariance.diagonal().cwiseSqrt();
        const Eigen::VectorXd per_deviation =
            (deviations.array() > 0.0).select(deviations.cwiseInverse(), 0.0);
        sizes_ = Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()))
                     .cwiseProduct(per_deviation);
        correlations_ = per_deviation.asDiagonal() * fitted.curvature_covariance * per_deviation.asDiagonal();
    }

    /// Loss that some candidates together save beside the others.
    double worth(const std::vector<std::size_t>& left_out) const {
        Indices sizes, shapes;
        for (const std::size_t c : left_out) {
            sizes.insert(sizes.end(), of_[c].sizes.begin(), of_[c].sizes.end());
            shapes.insert(shapes.end(), of_[c].shapes.begin(), of_[c].shapes.end());
        }
        if (sizes.empty()) return 0.0;
        Eigen::MatrixXd own = correlations_(sizes, sizes);
        if (!shapes.empty()) {
            const Eigen::MatrixXd with_shapes = correlations_(sizes, shapes);
            own -=
                with_shapes * minimum_norm_solutions(correlations_(shapes, shapes), with_shapes.transpose());
        }
        const Eigen::VectorXd values = sizes_(sizes);
        return 0.5 * values.dot(minimum_norm_solution(own, values));
    }

  private:
    /// Where a candidate's parameters are among all.
    struct Parameters {
        Indices sizes, shapes;
    };

    std::vector<Parameters> of_;  ///< each candidate's
    Eigen::VectorXd sizes_;       ///< of all parameters
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

/// The candidates that remain and those that are left out, and what the latter would save.
class Subset {
  public:
    Subset(std::span<const Candidate* const> candidates, const Fit& fitted, const Demand& demand,
           bool spares_held)
        : sizes_(std::make_shared<const Sizes>(candidates, fitted)), rest_(candidates.size()) {
        std::iota(rest_.begin(), rest_.end(), std::size_t{0});
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            demanded_.push_back(demand.worth_of(*candidates[c]));
            is_spared_.push_back(spares_held && is_held(fitted.hypothesis[c]));
        }
    }

    /// In the order of the candidates.
    std::vector<std::size_t> rest() const {
        std::vector<std::size_t> sorted = rest_;
        std::ranges::sort(sorted);
        return sorted;
    }

    /// @param stays  one that is not removed, however little it saves
    void remove_what_saves_little(std::optional<std::size_t> stays = {}) {
        while (!rest_.empty()) {
            double least = std::numeric_limits<double>::infinity(), lost_with_it = lost_;
            std::size_t at = 0;
            for (std::size_t k = 0; k < rest_.size(); ++k) {
                if (is_spared_[rest_[k]] || rest_[k] == stays) continue;
                std::vector<std::size_t> without = left_out_;
                without.push_back(rest_[k]);
                const double worth = sizes_->worth(without);
                const double share = (worth - lost_) / demanded_[rest_[k]];
                if (share >= least) continue;
                least = share;
                lost_with_it = worth;
                at = k;
            }
            if (least >= 1.0) return;
            lost_ = std::max(lost_, lost_with_it);
            left_out_.push_back(rest_[at]);
            rest_.erase(rest_.begin() + static_cast<std::ptrdiff_t>(at));
        }
    }

    /// Puts back the one beside which the rest and what it leaves cost least, if that is less than now.
    /// @return whether there was one
    bool exchange() {
        const Subset now = *this;
        double least = cost() - hardly_worth;
        bool is_better = false;
        for (std::size_t k = 0; k < now.left_out_.size(); ++k) {
            Subset other = now;
            other.put_back(k);
            other.remove_what_saves_little(now.left_out_[k]);
            if (other.cost() >= least) continue;
            least = other.cost();
            *this = std::move(other);
            is_better = true;
        }
        return is_better;
    }

  private:
    /// What is lost, and what is demanded of each that remains.
    double cost() const {
        return std::accumulate(rest_.begin(), rest_.end(), lost_,
                               [&](double sum, std::size_t c) { return sum + demanded_[c]; });
    }

    void put_back(std::size_t k) {
        rest_.push_back(left_out_[k]);
        left_out_.erase(left_out_.begin() + static_cast<std::ptrdiff_t>(k));
        lost_ = sizes_->worth(left_out_);
    }

    std::shared_ptr<const Sizes> sizes_;  ///< of all candidates, the same for every subset
    std::vector<double> demanded_;        ///< of each candidate
    std::vector<bool> is_spared_;
    std::vector<std::size_t> rest_, left_out_;
    double lost_ = 0.0;  ///< by all that are left out
};

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
    Subset subset(candidates, fitted, demand, spares_held);
    subset.remove_what_saves_little();
    while (subset.exchange()) {
    }
    return subset.rest();
}

std::vector<double> worth_of_each(std::span<const Candidate* const> candidates, const Fit& fitted) {
    const Sizes sizes(candidates, fitted);
    std::vector<double> worth;
    for (std::size_t c = 0; c < candidates.size(); ++c) worth.push_back(sizes.worth({c}));
    return worth;
}

}  // namespace fidservo::gap
