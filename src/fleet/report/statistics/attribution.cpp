// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/report/statistics/attribution.h"

#include "src/fleet/report/statistics/censored.h"
#include "src/fleet/report/statistics/explanation.h"
#include "src/fleet/report/statistics/limited_sizes.h"
#include "src/fleet/report/statistics/log_of_sum.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <numeric>
#include <span>
#include <utility>

namespace fidservo::fleet {
namespace {

constexpr std::size_t most_shares = 24, most_at_once = 8, least_units = 3;

/// A set of units that may have a share.
struct CandidateSet {
    Whose whose;
    std::optional<std::size_t> which;  ///< none: a part of the units that no group is
    std::vector<std::size_t> units;
    double log_prior_odds;
};

/// So that sets keep their places while parts are added.
using CandidateSets = std::list<CandidateSet>;

/// As many units are told one by one at most; of more that are alike a part is made.
std::size_t most_one_by_one(std::size_t units) {
    return std::min(most_at_once, units / least_units);
}

double log_odds_of_kind(double quantities) {
    return -std::log(3.0 * quantities);
}

CandidateSets candidate_sets(std::size_t units, std::span<const std::vector<std::size_t>> groups,
                             double quantities) {
    const double each_kind = log_odds_of_kind(quantities);
    CandidateSets sets(1, {Whose::all, 0, std::vector<std::size_t>(units), each_kind});
    std::iota(sets.front().units.begin(), sets.front().units.end(), std::size_t{0});
    for (std::size_t g = 0; g < groups.size(); ++g)
        sets.push_back(
            {Whose::group, g, groups[g], each_kind - std::log(static_cast<double>(groups.size()))});
    for (std::size_t u = 0; u < units; ++u)
        sets.push_back({Whose::unit, u, {u}, each_kind - std::log(static_cast<double>(units))});
    return sets;
}

/// log of 1 / (n (n over k)): all sizes of a part are equally likely, and of one size all parts.
double log_prior_of_part(std::size_t count, std::size_t units) {
    const auto n = static_cast<double>(units), k = static_cast<double>(count);
    return std::lgamma(k + 1.0) + std::lgamma(n - k + 1.0) - std::lgamma(n + 1.0) - std::log(n);
}

/// A set that has a share, and the law of the share's size under which it is likeliest.
struct TakenSet {
    const CandidateSet* set;
    double law;
};

Explanation explanation_by(std::span<const Level> levels, std::span<const TakenSet> taken) {
    Explanation explanation(levels);
    for (const TakenSet& one : taken) explanation.take(one.set->units, one.law);
    return explanation;
}

TakenShares shares_of(std::size_t units, std::span<const TakenSet> taken) {
    TakenShares shares(units);
    for (const TakenSet& one : taken) shares.take(one.set->units, one.law);
    return shares;
}

/// The likeliest part of the units to have a share beside an explanation, those of which most, or least, is
/// left; with the natural log odds for it, and the law of its size.
struct LikeliestPart {
    CandidateSet set;
    double log_odds, law;
};

LikeliestPart likeliest_part(const Explanation& explanation, std::size_t units, double quantities) {
    LikeliestPart best{{Whose::group, {}, {}, 0.0}, -1e300, 0.0};
    const std::size_t least = most_one_by_one(units) + 1;
    std::vector<std::size_t> order = explanation.by_what_is_left();
    for (int end = 0; end < 2; ++end, std::ranges::reverse(order)) {
        const std::vector<WithFurther> further = explanation.with_first_of(order);
        for (std::size_t count = least; count + least <= units; ++count) {
            const double prior = log_odds_of_kind(quantities) + log_prior_of_part(count, units);
            const double odds = further[count - 1].log_likelihood - explanation.log_likelihood() + prior;
            if (odds <= best.log_odds) continue;
            best = {{Whose::group, {}, {}, prior}, odds, further[count - 1].law};
            best.set.units.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
        }
    }
    std::ranges::sort(best.set.units);
    return best;
}

/// The set that is likeliest to have a share beside an explanation by those taken, with the natural log odds
/// for it. A part is added to the sets.
std::pair<TakenSet, double> likeliest_beside(const Explanation& explanation, std::span<const TakenSet> taken,
                                             std::size_t units, CandidateSets& sets, double quantities) {
    std::pair<TakenSet, double> best{{nullptr, 0.0}, -1e300};
    for (const CandidateSet& set : sets) {
        if (std::ranges::find(taken, &set, &TakenSet::set) != taken.end()) continue;
        const WithFurther further = explanation.with(set.units);
        const double odds = further.log_likelihood - explanation.log_likelihood() + set.log_prior_odds;
        if (odds > best.second) best = {{&set, further.law}, odds};
    }
    if (LikeliestPart part = likeliest_part(explanation, units, quantities); part.log_odds > best.second) {
        auto known = std::ranges::find(sets, part.set.units, &CandidateSet::units);
        if (known == sets.end()) known = sets.insert(sets.end(), std::move(part.set));
        best = {{&*known, part.law}, part.log_odds};
    }
    return best;
}

/// Those taken with the next set, or with the next few that only together have odds of 19 to 1: while several
/// units are off, and none of them has a share, the spread explains them all. As they were where no few have.
std::vector<TakenSet> with_next(std::span<const Level> levels, CandidateSets& sets,
                                const std::vector<TakenSet>& taken, double quantities) {
    const std::size_t most = most_one_by_one(levels.size());
    std::vector<TakenSet> longer = taken;
    Explanation explanation = explanation_by(levels, taken);
    double log_odds = 0.0;
    while (longer.size() < std::min(taken.size() + most, sets.size())) {
        const auto [set, odds] = likeliest_beside(explanation, longer, levels.size(), sets, quantities);
        longer.push_back(set);
        log_odds += odds;
        if (log_odds >= least_log_odds) return longer;
        explanation.take(set.set->units, set.law);
    }
    return taken;
}

/// A set's share, judged beside an explanation without it.
Share share_beside(const Explanation& explanation, const CandidateSets& sets, const CandidateSet& of) {
    Share share{.whose = of.whose, .which = of.which, .units = of.units, .size = {}};
    share.log_all = share.log_group = share.log_unit = -1e300;
    std::vector<double> all_odds{0.0};
    for (const CandidateSet& set : sets) {
        const double ratio = explanation.with(set.units).log_likelihood - explanation.log_likelihood();
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
std::vector<Share> pruned(std::span<const Level> levels, const CandidateSets& sets,
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

/// Takes away a part that has no odds of 19 to 1 once levels that are not named are what they are: units that
/// happen to be named differ from those that are not, which as normal laws are all about 0.
/// @return whether there was one
bool take_away_part_by_naming(std::span<const Level> levels, std::vector<TakenSet>& taken) {
    const auto is_part = [](const TakenSet& one) { return !one.set->which; };
    if (std::ranges::none_of(taken, is_part)) return false;
    const auto log_likelihood = [&](std::span<const TakenSet> sets) {
        return limited_sizes(levels, shares_of(levels.size(), sets)).log_likelihood;
    };
    const double with_all = log_likelihood(taken);
    for (std::size_t j = 0; j < taken.size(); ++j) {
        if (!is_part(taken[j])) continue;
        std::vector<TakenSet> others = taken;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(j));
        if (with_all - log_likelihood(others) + taken[j].set->log_prior_odds >= least_log_odds) continue;
        taken = std::move(others);
        return true;
    }
    return false;
}

}  // namespace

Attribution attribute(std::span<const Level> levels, std::span<const std::vector<std::size_t>> groups,
                      double quantities) {
    if (levels.size() < least_units) {
        Attribution untold;
        for (const Level& level : levels) untold.levels.push_back(level.value);
        return untold;
    }
    std::vector<Level> normals;
    for (const Level& level : levels) normals.push_back(as_normal(level));
    CandidateSets sets = candidate_sets(levels.size(), groups, quantities);
    std::vector<TakenSet> taken;
    while (taken.size() < most_shares) {
        std::vector<TakenSet> longer = with_next(normals, sets, taken, quantities);
        if (longer.size() == taken.size()) break;
        taken = std::move(longer);
    }
    Attribution attribution;
    attribution.shares = pruned(normals, sets, taken);
    while (take_away_part_by_naming(levels, taken)) attribution.shares = pruned(normals, sets, taken);
    LimitedSizes found = limited_sizes(levels, shares_of(levels.size(), taken));
    for (std::size_t j = 0; j < taken.size(); ++j) attribution.shares[j].size = found.sizes[j];
    attribution.levels = std::move(found.levels);
    attribution.spread = found.spread;
    return attribution;
}

}  // namespace fidservo::fleet
