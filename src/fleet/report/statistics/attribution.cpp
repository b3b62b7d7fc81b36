// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/attribution.h"

#include "src/fleet/report/statistics/log_of_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Dense>

namespace fidservo::fleet {
namespace {

constexpr std::array share_laws{1.0, 4.0, 16.0, 64.0};
constexpr std::size_t spread_count = 26, most_shares = 24;
constexpr double least_log_odds = 2.944438979166440;  // log 19

double spread_at(std::size_t k) {
    constexpr double least = 0.05, ratio = 1.413;  // 0.05 to 200 floors
    return k == 0 ? 0.0 : least * std::pow(ratio, static_cast<double>(k - 1));
}

double log_prior_of_spread(std::size_t k) {
    return k == 0 ? std::log(0.5) : std::log(0.5 / static_cast<double>(spread_count - 1));
}

/// A set of units that may have a share.
struct CandidateSet {
    Whose whose;
    std::size_t which;
    std::vector<std::size_t> units;
    double log_prior_odds;
};

std::vector<CandidateSet> candidate_sets(std::size_t units, std::span<const std::vector<std::size_t>> groups,
                                         double quantities) {
    const double each_kind = -std::log(3.0 * quantities);
    std::vector<CandidateSet> sets(1, {Whose::all, 0, std::vector<std::size_t>(units), each_kind});
    std::iota(sets[0].units.begin(), sets[0].units.end(), std::size_t{0});
    for (std::size_t g = 0; g < groups.size(); ++g)
        sets.push_back(
            {Whose::group, g, groups[g], each_kind - std::log(static_cast<double>(groups.size()))});
    for (std::size_t u = 0; u < units; ++u)
        sets.push_back({Whose::unit, u, {u}, each_kind - std::log(static_cast<double>(units))});
    return sets;
}

/// The explanation so far at one spread: Bayesian least squares of the levels by the shares' columns.
struct AtSpread {
    Eigen::VectorXd weights;     ///< 1 / (s^2 + tau^2) of each unit
    Eigen::MatrixXd covariance;  ///< of the shares, (X' W X + G^-1)^-1
    Eigen::VectorXd sizes;       ///< of the shares
    Eigen::VectorXd left;        ///< levels less the shares
    double log_likelihood = 0.0;
};

/// Shares that were taken in: a column of zeros and ones each, and the law of its size.
struct Taken {
    Eigen::MatrixXd columns;
    std::vector<double> laws;
};

AtSpread at_spread(std::span<const Level> levels, const Taken& taken, double spread) {
    AtSpread at;
    const auto units = static_cast<Eigen::Index>(levels.size());
    at.weights.resize(units);
    Eigen::VectorXd values(units);
    double log_determinant = 0.0;
    for (Eigen::Index u = 0; u < units; ++u) {
        const Level& level = levels[static_cast<std::size_t>(u)];
        at.weights(u) = 1.0 / (level.std * level.std + spread * spread);
        values(u) = level.value;
        log_determinant -= std::log(at.weights(u));
    }
    const auto shares = static_cast<Eigen::Index>(taken.laws.size());
    Eigen::MatrixXd precision = taken.columns.transpose() * at.weights.asDiagonal() * taken.columns;
    for (Eigen::Index j = 0; j < shares; ++j) {
        const double law = taken.laws[static_cast<std::size_t>(j)];
        precision(j, j) += 1.0 / (law * law);
        log_determinant += 2.0 * std::log(law);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(precision);
    for (Eigen::Index j = 0; j < shares; ++j) log_determinant += 2.0 * std::log(factor.matrixL()(j, j));
    const Eigen::VectorXd weighted = at.weights.cwiseProduct(values);
    const Eigen::VectorXd products = taken.columns.transpose() * weighted;
    at.covariance = factor.solve(Eigen::MatrixXd::Identity(shares, shares));
    at.sizes = at.covariance * products;
    at.left = values - taken.columns * at.sizes;
    at.log_likelihood = -0.5 * (log_determinant + values.dot(weighted) - products.dot(at.sizes));
    return at;
}

/// Of a further column beside those taken: its own weighted square, and its product with what is left.
struct FurtherColumn {
    double square = 0.0, product = 0.0;

    /// What it changes the log likelihood by, with the law of its size.
    double log_gain(double law) const {
        const double gain = law * law * square;
        return -0.5 * std::log1p(gain) + 0.5 * product * product * law * law / (1.0 + gain);
    }
};

FurtherColumn further_column(const AtSpread& at, const Taken& taken, const CandidateSet& set) {
    FurtherColumn column;
    Eigen::VectorXd shared = Eigen::VectorXd::Zero(taken.columns.cols());
    for (const std::size_t u : set.units) {
        const auto unit = static_cast<Eigen::Index>(u);
        column.square += at.weights(unit);
        column.product += at.weights(unit) * at.left(unit);
        shared += at.weights(unit) * taken.columns.row(unit).transpose();
    }
    column.square = std::max(0.0, column.square - shared.dot(at.covariance * shared));
    return column;
}

class Explanation {
  public:
    explicit Explanation(std::span<const Level> levels) : levels_(levels) {
        taken_.columns.resize(static_cast<Eigen::Index>(levels.size()), 0);
        fit();
    }

    double log_likelihood() const { return log_likelihood_; }

    /// With a further set, its size's law averaged over; the law under which it is likeliest.
    std::pair<double, double> log_likelihood_with(const CandidateSet& set) const {
        std::array<std::array<double, spread_count>, share_laws.size()> terms{};
        for (std::size_t s = 0; s < spread_count; ++s) {
            const FurtherColumn column = further_column(at_[s], taken_, set);
            const double so_far = log_prior_of_spread(s) + at_[s].log_likelihood;
            for (std::size_t k = 0; k < share_laws.size(); ++k)
                terms[k][s] = so_far + column.log_gain(share_laws[k]);
        }
        std::array<double, share_laws.size()> of_laws{};
        std::ranges::transform(terms, of_laws.begin(), [](const auto& of_law) { return log_of_sum(of_law); });
        const auto best = static_cast<std::size_t>(std::ranges::max_element(of_laws) - of_laws.begin());
        return {log_of_sum(of_laws) - std::log(static_cast<double>(share_laws.size())), share_laws[best]};
    }

    void take(const CandidateSet& set, double law) {
        const Eigen::Index last = taken_.columns.cols();
        taken_.columns.conservativeResize(Eigen::NoChange, last + 1);
        taken_.columns.col(last).setZero();
        for (const std::size_t u : set.units) taken_.columns(static_cast<Eigen::Index>(u), last) = 1.0;
        taken_.laws.push_back(law);
        fit();
    }

    double spread() const { return spread_at(likeliest_); }

    Level size(std::size_t share) const {
        const auto j = static_cast<Eigen::Index>(share);
        return {at_[likeliest_].sizes(j), std::sqrt(at_[likeliest_].covariance(j, j))};
    }

  private:
    void fit() {
        at_.clear();
        std::array<double, spread_count> terms{};
        for (std::size_t s = 0; s < spread_count; ++s) {
            at_.push_back(at_spread(levels_, taken_, spread_at(s)));
            terms[s] = log_prior_of_spread(s) + at_.back().log_likelihood;
        }
        log_likelihood_ = log_of_sum(terms);
        likeliest_ = static_cast<std::size_t>(std::ranges::max_element(at_, {}, &AtSpread::log_likelihood) -
                                              at_.begin());
    }

    std::span<const Level> levels_;
    Taken taken_;
    std::vector<AtSpread> at_;
    double log_likelihood_ = 0.0;
    std::size_t likeliest_ = 0;
};

/// A set that has a share, and the law of the share's size under which it is likeliest.
struct TakenSet {
    const CandidateSet* set;
    double law;
};

Explanation explanation_by(std::span<const Level> levels, std::span<const TakenSet> taken) {
    Explanation explanation(levels);
    for (const TakenSet& one : taken) explanation.take(*one.set, one.law);
    return explanation;
}

/// The set that is likeliest to have a share beside an explanation by those taken, with the natural log odds
/// for it.
std::pair<TakenSet, double> likeliest_beside(const Explanation& explanation, std::span<const TakenSet> taken,
                                             const std::vector<CandidateSet>& sets) {
    std::pair<TakenSet, double> best{{nullptr, 0.0}, -1e300};
    for (const CandidateSet& set : sets) {
        if (std::ranges::find(taken, &set, &TakenSet::set) != taken.end()) continue;
        const auto [log_likelihood, law] = explanation.log_likelihood_with(set);
        const double odds = log_likelihood - explanation.log_likelihood() + set.log_prior_odds;
        if (odds > best.second) best = {{&set, law}, odds};
    }
    return best;
}

/// Those taken with the next set, or with the next few that only together have odds of 19 to 1: while several
/// units are off, and none of them has a share, the spread explains them all. As they were where no few have.
std::vector<TakenSet> with_next(std::span<const Level> levels, const std::vector<CandidateSet>& sets,
                                const std::vector<TakenSet>& taken, std::size_t most) {
    std::vector<TakenSet> longer = taken;
    Explanation explanation = explanation_by(levels, taken);
    double log_odds = 0.0;
    while (longer.size() < std::min(taken.size() + most, sets.size())) {
        const auto [set, odds] = likeliest_beside(explanation, longer, sets);
        longer.push_back(set);
        log_odds += odds;
        if (log_odds >= least_log_odds) return longer;
        explanation.take(*set.set, set.law);
    }
    return taken;
}

/// A set's share, judged beside an explanation without it.
Share share_beside(const Explanation& explanation, const std::vector<CandidateSet>& sets,
                   const CandidateSet& of) {
    Share share{.whose = of.whose, .which = of.which, .size = {}};
    share.log_all = share.log_group = share.log_unit = -1e300;
    std::vector<double> all_odds{0.0};
    for (const CandidateSet& set : sets) {
        const double ratio = explanation.log_likelihood_with(set).first - explanation.log_likelihood();
        double& of_kind = set.whose == Whose::all     ? share.log_all
                          : set.whose == Whose::group ? share.log_group
                                                      : share.log_unit;
        of_kind = std::max(of_kind, ratio);
        all_odds.push_back(ratio + set.log_prior_odds);
        if (&set == &of) share.log_odds = all_odds.back();
    }
    share.probability = std::exp(share.log_odds - log_of_sum(all_odds));
    return share;
}

/// Takes away what the others explain as well, the least likely first, until all that is left has odds of 19
/// to 1.
std::vector<Share> pruned(std::span<const Level> levels, const std::vector<CandidateSet>& sets,
                          std::vector<TakenSet>& taken) {
    while (true) {
        std::vector<Share> shares;
        for (std::size_t j = 0; j < taken.size(); ++j) {
            std::vector<TakenSet> others = taken;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(j));
            shares.push_back(share_beside(explanation_by(levels, others), sets, *taken[j].set));
        }
        const auto least = std::ranges::min_element(shares, {}, &Share::log_odds);
        if (least == shares.end() || least->log_odds >= least_log_odds) return shares;
        taken.erase(taken.begin() + (least - shares.begin()));
    }
}

}  // namespace

Attribution attribute(std::span<const Level> levels, std::span<const std::vector<std::size_t>> groups,
                      double quantities) {
    constexpr std::size_t least_units = 3, most_at_once = 8;
    if (levels.size() < least_units) return {};
    const std::vector<CandidateSet> sets = candidate_sets(levels.size(), groups, quantities);
    std::vector<TakenSet> taken;
    while (taken.size() < most_shares) {
        std::vector<TakenSet> longer =
            with_next(levels, sets, taken, std::min(most_at_once, levels.size() / least_units));
        if (longer.size() == taken.size()) break;
        taken = std::move(longer);
    }
    Attribution attribution{.shares = pruned(levels, sets, taken)};
    const Explanation explanation = explanation_by(levels, taken);
    for (std::size_t j = 0; j < taken.size(); ++j) attribution.shares[j].size = explanation.size(j);
    attribution.spread = explanation.spread();
    return attribution;
}

}  // namespace fidservo::fleet
