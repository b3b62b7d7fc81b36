// Two effects at once, where each hides the other.
#include "core/rig.h"
#include "gap/contender.h"
#include "gap/pair_sight.h"
#include "gap/parallel.h"
#include "gap/score.h"
#include "gap/search.h"
#include "gap/starts.h"
#include "gap/wave_starts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

namespace fidservo::gap {
namespace {

/// What a fit finds from typical values, without looking for a shape, of the carriage, where friction lets go
/// by jumps and slopes mislead.
bool is_plain(const Candidate& candidate) {
    const bool knows_its_shape = candidate.sizes.size() == unrefined_parameters(*candidate.effect);
    return !candidate.is_limit && moves_carriage(*candidate.effect) && knows_its_shape;
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

/// Whether the balance of a carriage's forces shows it.
bool is_balanced(const Candidate& candidate) {
    return !candidate.is_limit && shows_in_balance(*candidate.effect);
}

/// Places to fit of a base with two added that meet, the first one given.
Places fitted_with_pair(const CrossFit& base, const Candidate& first) {
    Places places = coupled_with(base.of_half[0], *first.effect);
    for (const std::size_t added : {0, 1}) places.push_back(base.of_half[0].size() + added);
    return places;
}

}  // namespace

struct Search::PairAttempt {
    const Candidate *first, *second;
    Places places;  ///< to fit, the two last
    Hypothesis start;
    Fit fitted = {};
};

Search::PairAttempt Search::attempt(const CrossFit& base, const Candidate& first, const Candidate& second,
                                    Hypothesis settings) const {
    Hypothesis start = base.of_half[0];
    std::ranges::move(settings, std::back_inserter(start));
    return {&first, &second, fitted_with_pair(base, first), std::move(start)};
}

void Search::add_typical(const CrossFit& base, const Candidate& first, const Candidate& second,
                         std::vector<PairAttempt>& attempts) const {
    for (const plant::EffectSetting& one : typical_of_both_signs(first))
        for (const plant::EffectSetting& other : typical_of_both_signs(second))
            attempts.push_back(attempt(base, first, second, {one, other}));
}

const std::vector<ForcePair>& Search::force_pairs(const CrossFit& base,
                                                  std::vector<const Candidate*> candidates) {
    std::erase_if(candidates, [](const Candidate* candidate) { return !is_balanced(*candidate); });
    Hypothesis known = moving_carriage(base.of_half[0]);
    if (last_balance_.base == known && last_balance_.candidates == candidates) return last_balance_.pairs;
    const Evidence& evidence = fitter_.evidence();
    const Wanted wanted = only_of(evidence.windows(), fitter_.half(0), only(Signal::encoder));
    std::vector<PositionPeriod> periods;
    if (std::ranges::any_of(candidates, [](const Candidate* c) { return c->wave.has_value(); }))
        periods = periods_along_rail(evidence, known, evidence.errors(known, wanted));
    std::vector<ForcePair> pairs = strongest_force_pairs(evidence, wanted, known, candidates, periods);
    last_balance_ = {std::move(known), std::move(candidates), std::move(pairs)};
    return last_balance_.pairs;
}

bool Search::moves_as_a_pair(const CrossFit& base, const ForcePair& pair) const {
    constexpr double clearly_less = 0.5;
    if (!pair.lone) return false;
    const auto loss_with = [&](const Hypothesis& settings) {
        Hypothesis whole = base.of_half[0];
        std::ranges::copy(settings, std::back_inserter(whole));
        return loss_on_half(0, whole, *pair.first);
    };
    const double enough = clearly_less * loss_with({*pair.lone});
    return std::ranges::any_of(pair.starts,
                               [&](const Hypothesis& start) { return loss_with(start) < enough; });
}

std::vector<Search::PairAttempt> Search::by_force(const CrossFit& base,
                                                  std::vector<const Candidate*> candidates,
                                                  bool only_needed) {
    std::vector<PairAttempt> attempts;
    for (const ForcePair& pair : force_pairs(base, std::move(candidates)))
        if (!only_needed || pair.needs_both || moves_as_a_pair(base, pair))
            for (const Hypothesis& start : pair.starts)
                attempts.push_back(attempt(base, *pair.first, *pair.second, start));
    return attempts;
}

std::vector<Search::PairAttempt> Search::by_typical_sizes(const CrossFit& base,
                                                          std::vector<const Candidate*> candidates) const {
    std::erase_if(candidates, [](const Candidate* candidate) { return !is_plain(*candidate); });
    std::vector<PairAttempt> attempts;
    for (std::size_t a = 0; a < candidates.size(); ++a)
        for (std::size_t b = a + 1; b < candidates.size(); ++b) {
            const Candidate &first = *candidates[a], &second = *candidates[b];
            if (first.class_name == second.class_name || (is_balanced(first) && is_balanced(second)) ||
                !meet(teachers_of(*first.effect), teachers_of(*second.effect)))
                continue;
            add_typical(base, first, second, attempts);
        }
    return attempts;
}

std::vector<Search::PairAttempt> Search::by_sight(const CrossFit& base,
                                                  std::vector<const Candidate*> candidates) const {
    constexpr std::size_t most = 6;
    std::erase_if(candidates,
                  [](const Candidate* candidate) { return candidate->is_limit || !is_of_wire(*candidate); });
    SignalFlags seen{};
    for (const Candidate* candidate : candidates) seen = either(seen, teachers_of(*candidate->effect));
    const Wanted wanted = fitter_.instructive_of(0, seen, base.mean_squares);
    std::vector<PairAttempt> attempts;
    std::vector<PairSight> pairs = pairs_at_first_sight(
        fitter_.predictor(wanted), fitter_.evidence().windows(), wanted, base.of_half[0], candidates);
    if (pairs.size() > most) pairs.resize(most);
    for (PairSight& pair : pairs) {
        attempts.push_back(attempt(base, *pair.first, *pair.second, std::move(pair.settings)));
        // Far off, what is best nearby may lead elsewhere.
        add_typical(base, *pair.first, *pair.second, attempts);
    }
    return attempts;
}

void Search::add_beside_ripple(const CrossFit& base, const Candidate& other, const Candidate& ripple,
                               std::vector<PairAttempt>& attempts) const {
    constexpr std::size_t most_periods = 2;
    constexpr double worth_a_fit = 0.2;  // of the loss
    const Evidence& evidence = fitter_.evidence();
    const std::vector<Window>& windows = evidence.windows();
    const Hypothesis& known = base.of_half[0];
    const Wanted wanted = fitter_.instructive_of(0, teachers_of(*other.effect), base.mean_squares);
    const Predict predict = fitter_.predictor(wanted);
    const double loss = total_loss(windows, wanted, predict(known));
    std::vector<PositionPeriod> periods =
        periods_along_rail(evidence, known, evidence.errors(known, fitter_.half(0)));
    if (periods.size() > most_periods) periods.resize(most_periods);
    for (const PositionPeriod& period : periods) {
        Hypothesis rippled = known;
        rippled.push_back(wave_at(ripple, period));
        const Errors errors = predict(rippled);
        const Surroundings beside = surroundings(predict, windows, wanted, rippled, errors, {});
        const std::vector<Promise> starts = starts_of(other, {}, predict, windows, wanted, beside);
        if (starts.empty() ||
            total_loss(windows, wanted, errors) - starts.front().gain > (1.0 - worth_a_fit) * loss)
            continue;
        attempts.push_back(attempt(base, other, ripple, {starts.front().start.back(), rippled.back()}));
    }
}

std::optional<Pair> Search::best_of(const CrossFit& base, std::vector<PairAttempt> attempts,
                                    double loss_to_beat) {
    const auto fit_on = [&](int most_iterations) {
        parallel_for(attempts.size(), [&](std::size_t k) {
            PairAttempt& attempt = attempts[k];
            attempt.fitted = fitter_.fit_places(0, attempt.start, attempt.places, base.mean_squares,
                                                {.most_iterations = most_iterations});
            attempt.start = attempt.fitted.hypothesis;
            if (attempt.second->wave) attempt.fitted.loss = loss_on_half(0, attempt.start, *attempt.second);
        });
        std::ranges::sort(attempts, {}, [](const PairAttempt& attempt) { return attempt.fitted.loss; });
    };
    constexpr int first_iterations = 4, further_iterations = 12;
    constexpr std::size_t most_fitted_on = 4;
    trials_ += static_cast<int>(attempts.size());
    fit_on(first_iterations);
    if (attempts.size() > most_fitted_on) attempts.resize(most_fitted_on);
    fit_on(further_iterations);
    if (attempts.empty() || !std::isfinite(attempts.front().fitted.loss)) return {};
    const PairAttempt& best = attempts.front();
    Pair pair{best.first, best.second, {}};
    pair.fitted.mean_squares = base.mean_squares;
    fit_pair(base, pair, best.fitted.hypothesis);
    throw_if_exhausted();
    if (pair.fitted.loss > loss_to_beat) return {};
    // Both are judged against what they begin from, also where the effort is spent on the way.
    pair.fitted = closer(base, std::move(pair.fitted), *pair.second);
    return in_plain_form(base, std::move(pair));
}

void Search::fit_pair(const CrossFit& base, Pair& pair, const Hypothesis& start) const {
    const Places places = fitted_with_pair(base, *pair.first);
    Hypothesis found = part_of(start, places);
    // There and back: of two valleys beside each other a half may have missed the deeper one.
    for (const std::size_t side : {1, 0, 1}) {
        Hypothesis whole = base.of_half[side];
        whole.resize(whole.size() + 2);
        pair.fitted.of_half[side] =
            fitter_
                .fit_places(side, with_part(std::move(whole), places, found), places,
                            pair.fitted.mean_squares, {.tolerance = 1e-7, .step_scales = close_step})
                .hypothesis;
        found = part_of(pair.fitted.of_half[side], places);
    }
    fitter_.judge(pair.fitted);
}

CrossFit Search::closer(const CrossFit& base, CrossFit whole, const Candidate& last) const {
    constexpr double share_of_effort = 0.5;
    CrossFit rest = base;
    for (std::size_t side = 0; side < 2; ++side)
        rest.of_half[side].assign(whole.of_half[side].begin(), whole.of_half[side].end() - 1);
    Finding finding;
    Contender contender{{.candidate = &last, .gain = base.loss - whole.loss, .fitted = std::move(whole)},
                        coupled_with(rest.of_half[0], *last.effect),
                        &finding};
    for (std::size_t side = 0; side < 2; ++side)
        finding.fitted[side] = contender.part(contender.trial.fitted.of_half[side]);
    fit_closer(rest, contender, true, share_of_effort);
    return std::move(contender.trial.fitted);
}

Pair Search::in_plain_form(const CrossFit& base, Pair pair) const {
    for (const Candidate& plainer : candidates_)
        for (const Candidate* Pair::*const place : {&Pair::first, &Pair::second}) {
            if (!is_limit_of(plainer.effect->name, (pair.*place)->effect->name) ||
                plainer.class_name == pair.first->class_name || plainer.class_name == pair.second->class_name)
                continue;
            Pair plain = pair;
            plain.*place = &plainer;
            Hypothesis start = pair.fitted.of_half[0];
            plant::EffectSetting& setting = start[start.size() - (place == &Pair::first ? 2 : 1)];
            setting = plain_form(setting, *plainer.effect, fitter_.evidence().rig().macro);
            fit_pair(base, plain, start);
            if (!nearly_clears(base, plain.fitted)) continue;
            plain.fitted = closer(base, std::move(plain.fitted), *plain.second);
            if (!is_real(plain.fitted, pair.fitted)) pair = std::move(plain);
        }
    return pair;
}

std::optional<Pair> Search::balanced_pair(const CrossFit& base, std::span<const Candidate* const> added,
                                          bool only_needed, double loss_to_beat) {
    return best_of(base, by_force(base, in_question(base, added), only_needed), loss_to_beat);
}

bool Search::balances_alone(const CrossFit& base, std::span<const Candidate* const> added,
                            const Candidate& candidate) {
    const std::vector<ForcePair>& pairs = force_pairs(base, in_question(base, added));
    return !pairs.empty() && !pairs.front().needs_both && pairs.front().lone &&
           pairs.front().lone->effect == candidate.effect;
}

std::optional<Pair> Search::scanned_pair(const CrossFit& base, std::span<const Candidate* const> added) {
    std::vector<const Candidate*> candidates = in_question(base, added);
    const auto wave = std::ranges::find_if(
        candidates, [](const Candidate* candidate) { return candidate->wave && candidate->wave->is_force; });
    if (wave == candidates.end()) return {};
    const Candidate& scanned = **wave;
    const std::vector<ForcePair>& pairs = force_pairs(base, std::move(candidates));
    if (pairs.empty() || !pairs.front().lone || pairs.front().lone->effect == scanned.effect) return {};
    const plant::EffectSetting& lone = *pairs.front().lone;
    const Candidate& first =
        *(pairs.front().first->effect == lone.effect ? pairs.front().first : pairs.front().second);
    Hypothesis beside = base.of_half[0];
    beside.push_back(lone);
    const std::optional<plant::EffectSetting> found = scanned_wave(beside, scanned);
    throw_if_exhausted();
    if (!found) return {};
    return best_of(base, {attempt(base, first, scanned, {lone, *found})});
}

std::optional<Pair> Search::best_pair(const CrossFit& base, std::span<const Candidate* const> added) {
    return best_of(base, by_typical_sizes(base, in_question(base, added)));
}

std::optional<Pair> Search::encoder_pair(const CrossFit& base, std::span<const Candidate* const> added) {
    std::vector<const Candidate*> candidates = in_question(base, added);
    std::erase_if(candidates, [](const Candidate* candidate) {
        return candidate->is_limit || candidate->effect->block != "macro.encoder";
    });
    const auto ripple = std::ranges::find_if(
        candidates, [](const Candidate* candidate) { return candidate->wave.has_value(); });
    if (ripple == candidates.end()) return {};
    std::vector<PairAttempt> attempts;
    for (const Candidate* const other : candidates)
        if (other != *ripple) add_beside_ripple(base, *other, **ripple, attempts);
    return best_of(base, std::move(attempts));
}

std::optional<Pair> Search::wire_pair(const CrossFit& base, std::span<const Candidate* const> added) {
    return best_of(base, by_sight(base, in_question(base, added)));
}

}  // namespace fidservo::gap
