// Two effects at once, where each hides the other.
#include "gap/contender.h"
#include "gap/parallel.h"
#include "gap/search.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace fidservo::gap {
namespace {

/// What a fit finds from typical values, without looking for a shape: of the carriage, where friction lets go
/// by jumps and slopes mislead, and of the wire, where one cause stands in for two; where each prediction is
/// quick.
bool is_plain(const Candidate& candidate) {
    const std::string_view block = candidate.effect->block;
    const bool is_of_wire = block == "micro.heater" || block == "micro.hysteresis";
    const bool knows_its_shape = candidate.sizes.size() == unrefined_parameters(*candidate.effect);
    return !candidate.is_limit && (is_of_wire || (block.starts_with("macro.") && knows_its_shape));
}

/// At its typical sizes, and at the opposite ones where it has them.
std::vector<plant::EffectSetting> typical_of_both_signs(const Candidate& candidate) {
    std::vector<plant::EffectSetting> settings{{candidate.effect, candidate.shapes.front()}};
    plant::EffectSetting opposite = settings.front();
    for (const std::size_t k : candidate.sizes) {
        const plant::EffectParameter& parameter = candidate.effect->parameters[k];
        opposite.values[k] = 2.0 * parameter.vanishing - opposite.values[k];
        if (opposite.values[k] < parameter.low || opposite.values[k] > parameter.high) return settings;
    }
    settings.push_back(std::move(opposite));
    return settings;
}

struct Attempt {
    const Candidate *first, *second;
    Places places;  ///< to fit, the two last
    Hypothesis start;
    Fit fitted = {};
};

}  // namespace

std::optional<Pair> Search::best_pair(const CrossFit& base, std::span<const Candidate* const> added) {
    std::vector<const Candidate*> plain = in_question(base, added);
    std::erase_if(plain, [](const Candidate* candidate) { return !is_plain(*candidate); });
    std::vector<Attempt> attempts;
    for (std::size_t a = 0; a < plain.size(); ++a)
        for (std::size_t b = a + 1; b < plain.size(); ++b) {
            const Candidate &first = *plain[a], &second = *plain[b];
            if (first.class_name == second.class_name ||
                !meet(teachers_of(*first.effect), teachers_of(*second.effect)))
                continue;
            ++trials_;
            Places places = coupled_with(base.of_half[0], *first.effect);
            for (const std::size_t place : {base.of_half[0].size(), base.of_half[0].size() + 1})
                places.push_back(place);
            for (const plant::EffectSetting& one : typical_of_both_signs(first))
                for (const plant::EffectSetting& other : typical_of_both_signs(second)) {
                    Hypothesis start = base.of_half[0];
                    start.push_back(one);
                    start.push_back(other);
                    attempts.push_back({&first, &second, places, std::move(start)});
                }
        }
    const auto fit_on = [&](int most_iterations) {
        parallel_for(attempts.size(), [&](std::size_t k) {
            Attempt& attempt = attempts[k];
            attempt.fitted = fitter_.fit_places(0, attempt.start, attempt.places, base.mean_squares,
                                                {.most_iterations = most_iterations});
            attempt.start = attempt.fitted.hypothesis;
        });
        std::ranges::sort(attempts, {}, [](const Attempt& attempt) { return attempt.fitted.loss; });
    };
    constexpr int first_iterations = 4, further_iterations = 12;
    constexpr std::size_t most_fitted_on = 4;
    fit_on(first_iterations);
    if (attempts.size() > most_fitted_on) attempts.resize(most_fitted_on);
    fit_on(further_iterations);
    if (attempts.empty() || !std::isfinite(attempts.front().fitted.loss)) return {};
    const Attempt& best = attempts.front();
    Pair pair{best.first, best.second, {}};
    pair.fitted.mean_squares = base.mean_squares;
    Hypothesis found = part_of(best.fitted.hypothesis, best.places);
    // There and back: of two valleys beside each other a half may have missed the deeper one.
    for (const std::size_t side : {1, 0, 1}) {
        Hypothesis start = base.of_half[side];
        start.resize(start.size() + 2);
        pair.fitted.of_half[side] =
            fitter_
                .fit_places(side, with_part(std::move(start), best.places, found), best.places,
                            pair.fitted.mean_squares,
                            {.tolerance = 1e-7, .threads = Threads::all, .step_scales = close_step})
                .hypothesis;
        found = part_of(pair.fitted.of_half[side], best.places);
    }
    fitter_.judge(pair.fitted);
    throw_if_exhausted();
    return pair;
}

}  // namespace fidservo::gap
