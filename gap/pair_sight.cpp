#include "gap/pair_sight.h"

#include "gap/first_sight.h"
#include "gap/parallel.h"
#include "gap/score.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace fidservo::gap {
namespace {

/// A candidate along one of its shapes.
struct Look {
    const Candidate* candidate;
    std::vector<double> shape;
    Errors change = {};  ///< of the errors, per share of the shape's sizes
};

plant::EffectSetting at_share(const Look& look, double share) {
    const Candidate& candidate = *look.candidate;
    return sized(candidate, look.shape,
                 Eigen::VectorXd::Constant(static_cast<Eigen::Index>(candidate.sizes.size()), share));
}

Hypothesis with(Hypothesis base, std::span<const plant::EffectSetting> added) {
    base.insert(base.end(), added.begin(), added.end());
    return base;
}

std::vector<Look> looks_of(const Predict& predict, const Hypothesis& base, const Errors& base_errors,
                           std::span<const Candidate* const> candidates) {
    constexpr double probe = 0.25;  // of the typical size
    std::vector<Look> looks;
    for (const Candidate* candidate : candidates)
        for (const std::vector<double>& shape : candidate->shapes) looks.push_back({candidate, shape});
    parallel_for(looks.size(), [&](std::size_t k) {
        looks[k].change = predict(with(base, std::array{at_share(looks[k], probe)}));
        for (std::size_t i = 0; i < looks[k].change.size(); ++i)
            looks[k].change[i] = (looks[k].change[i] - base_errors[i]) / static_cast<float>(probe);
    });
    std::erase_if(looks, [](const Look& look) { return look.change.empty(); });
    return looks;
}

}  // namespace

std::vector<PairSight> pairs_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                            const Wanted& counted, const Hypothesis& base,
                                            std::span<const Candidate* const> candidates) {
    const Errors base_errors = predict(base);
    const std::vector<double> base_squares = mean_squares(windows, base_errors);
    const std::vector<Look> looks = looks_of(predict, base, base_errors, candidates);
    std::vector<std::pair<std::size_t, std::size_t>> of_two_classes;
    for (std::size_t a = 0; a < looks.size(); ++a)
        for (std::size_t b = a + 1; b < looks.size(); ++b)
            if (looks[a].candidate->class_name != looks[b].candidate->class_name)
                of_two_classes.emplace_back(a, b);
    std::vector<PairSight> sights(of_two_classes.size());
    parallel_for(sights.size(), [&](std::size_t k) {
        const Look &one = looks[of_two_classes[k].first], &other = looks[of_two_classes[k].second];
        const Eigen::VectorXd shares = best_shares(windows, counted, base_errors, {one.change, other.change});
        PairSight& sight = sights[k] = {one.candidate, other.candidate, {}, 0.0};
        for (const double part : {1.0, 0.4}) {
            Hypothesis settings{at_share(one, part * shares(0)), at_share(other, part * shares(1))};
            const double gain = gained(windows, counted, base_squares, predict(with(base, settings)));
            if (sight.settings.empty() || gain > sight.gain) {
                sight.settings = std::move(settings);
                sight.gain = gain;
            }
        }
    });
    std::ranges::stable_sort(sights, std::greater{}, &PairSight::gain);
    std::vector<PairSight> best;
    for (PairSight& sight : sights)
        if (std::ranges::none_of(best, [&](const PairSight& known) {
                return known.first == sight.first && known.second == sight.second;
            }))
            best.push_back(std::move(sight));
    return best;
}

}  // namespace fidservo::gap
