// SPDX-License-Identifier: GPL-3.0-or-later
// The fits of a search's step: of simple candidates first, on the second half for leaders only.
#include "core/parallel.h"
#include "core/rig.h"
#include "gap/fit/polish.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"
#include "gap/search/contender.h"
#include "gap/search/search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

namespace fidservo::gap {
namespace {

/// Effects with few parameters are tried first: where one of them brings its signals to their floors, a
/// richer one is no better explanation.
bool is_simple(const Candidate& candidate) {
    return unrefined_parameters(*candidate.effect) <= 2;
}

/// Whether any effect has this optional parameter at work; one that several effects share acts on them all.
bool is_present(const Refinement& refinement, const Hypothesis& hypothesis) {
    return std::ranges::any_of(hypothesis, [&](const plant::EffectSetting& setting) {
        const auto& parameters = setting.effect->parameters;
        const auto same = std::ranges::find(parameters, refinement.name, &plant::EffectParameter::name);
        return same != parameters.end() &&
               !same->is_negligible(setting.values[static_cast<std::size_t>(same - parameters.begin())]);
    });
}

/// An optional parameter of the setting at an index of a hypothesis, and a value for it.
struct Refined {
    std::size_t place, parameter;
    std::string_view name;
    double value;
};

/// All ways to give one optional parameter, or two at once, to settings at some indices of a hypothesis that
/// lacks them.
std::vector<std::vector<Refined>> ways_to_refine(const Hypothesis& hypothesis, const Places& places) {
    std::vector<Refined> lacking;
    for (const std::size_t place : places)
        for (const Refinement& refinement : refinements_of(*hypothesis[place].effect))
            if (!is_present(refinement, hypothesis))
                for (const double value : refinement.values)
                    lacking.push_back({place, refinement.parameter, refinement.name, value});
    std::vector<std::vector<Refined>> ways;
    ways.reserve(lacking.size() * (lacking.size() + 1) / 2);
    for (const Refined& one : lacking) ways.push_back({one});
    for (std::size_t a = 0; a < lacking.size(); ++a)
        for (std::size_t b = a + 1; b < lacking.size(); ++b)
            if (lacking[a].name != lacking[b].name) ways.push_back({lacking[a], lacking[b]});
    return ways;
}

Hypothesis with_values(Hypothesis hypothesis, const std::vector<Refined>& added) {
    for (const Refined& one : added) hypothesis[one.place].values[one.parameter] = one.value;
    return hypothesis;
}

/// Whether a setting has a choice other than the usual one.
bool is_unusual(const plant::EffectSetting& setting) {
    const auto& parameters = setting.effect->parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k)
        if (parameters[k].is_unusual(setting.values[k])) return true;
    return false;
}

bool includes(const SignalFlags& all, const SignalFlags& some) {
    for (std::size_t s = 0; s < signal_count; ++s)
        if (some[s] && !all[s]) return false;
    return true;
}

}  // namespace

void Search::fit_simple_first(const CrossFit& base, std::span<Contender> contenders) const {
    std::vector<Contender*> simple, rich;
    for (Contender& contender : contenders)
        (is_simple(*contender.trial.candidate) ? simple : rich).push_back(&contender);
    fit_first_half(base, simple);
    std::erase_if(rich, [&](const Contender* other) {
        return std::ranges::any_of(simple, [&](const Contender* one) {
            return one->gain() > 0.0 && includes(one->teachers(), other->teachers()) &&
                   !meet(off(one->trial.fitted), other->teachers());
        });
    });
    fit_first_half(base, rich);
}

void Search::fit_first_half(const CrossFit& base, std::span<Contender* const> contenders) const {
    struct Attempt {
        Contender* contender;
        const Promise* promise;
        Fit fitted;
    };
    std::vector<Attempt> attempts;
    for (Contender* contender : contenders)
        if (contender->finding->fitted[0].empty())
            for (const Promise& promise : contender->finding->starts)
                if (promise.gain >= share_of_gain * contender->promised())
                    attempts.push_back({contender, &promise, {}});
    parallel_for(attempts.size(), [&](std::size_t k) {
        const Contender& contender = *attempts[k].contender;
        attempts[k].fitted = fitter_.fit_places(0, contender.placed(base, 0, attempts[k].promise->start),
                                                contender.fitted_places(base), base.mean_squares);
        // The few windows that are fitted may suit a wrong local minimum of a wave: its loss is compared over
        // all windows of the half.
        if (contender.trial.candidate->wave)
            attempts[k].fitted.loss =
                loss_on_half(0, attempts[k].fitted.hypothesis, *contender.trial.candidate);
    });
    std::map<const Contender*, double> least_loss;
    std::map<const Contender*, const Attempt*> usual;
    for (const Attempt& attempt : attempts) {
        constexpr double none_yet = std::numeric_limits<double>::infinity();
        const Contender* const contender = attempt.contender;
        const Attempt*& best_usual = usual[contender];
        if (!is_unusual(attempt.fitted.hypothesis.back()) &&
            (best_usual == nullptr || attempt.fitted.loss < best_usual->fitted.loss))
            best_usual = &attempt;
        double& least = least_loss.try_emplace(contender, none_yet).first->second;
        if (attempt.fitted.loss >= least) continue;
        least = attempt.fitted.loss;
        contender->finding->fitted[0] = contender->part(attempt.fitted.hypothesis);
    }
    parallel_for(contenders.size(), [&](std::size_t k) { judge_first_half(base, *contenders[k]); });
    // An unusual choice may only stand in for an effect that is still missing: it is kept if it leaves no
    // gap, else the best fit with usual choices is.
    for (const auto& [contender, attempt] : usual) {
        Hypothesis& found = contender->finding->fitted[0];
        if (attempt == nullptr || found.empty() || !is_unusual(found.back()) ||
            !meet(off(contender->trial.fitted), contender->teachers()))
            continue;
        found = contender->part(attempt->fitted.hypothesis);
        judge_first_half(base, *attempt->contender);
    }
}

void Search::judge_first_half(const CrossFit& base, Contender& contender) const {
    Trial& trial = contender.trial;
    const Hypothesis& found = contender.finding->fitted[0];
    if (found.empty()) return;
    trial.fitted.of_half[0] = contender.placed(base, 0, found);
    const Wanted others = fitter_.instructive_of(1, contender.teachers(), base.mean_squares);
    trial.fitted.mean_squares = mean_squares(fitter_.evidence().windows(),
                                             fitter_.evidence().errors(trial.fitted.of_half[0], others));
    trial.gain = fitter_.compared(base, trial.fitted).gain;
}

void Search::fit_second_half(const CrossFit& base, Contender& contender) const {
    Finding& finding = *contender.finding;
    if (finding.fitted[1].empty()) {
        const Fit fit = fitter_.fit_places(1, contender.placed(base, 1, finding.fitted[0]),
                                           contender.fitted_places(base), base.mean_squares);
        finding.fitted[1] = contender.part(fit.hypothesis);
    }
    for (std::size_t side = 0; side < 2; ++side)
        contender.trial.fitted.of_half[side] = contender.placed(base, side, finding.fitted[side]);
    judge_both_halves(base, contender);
}

std::optional<Search::PlainForm> Search::plain_form_of(const plant::EffectSetting& setting) const {
    for (const Candidate& candidate : candidates_)
        if (is_limit_of(*candidate.effect, *setting.effect) && !candidate.is_limit)
            return PlainForm{&candidate, plain_form(setting, fitter_.evidence().rig().macro)};
    return {};
}

double Search::gain_where_looked(const CrossFit& base, const CrossFit& explanation) const {
    const Wanted looked_at = fitter_.instructive_of(0, focus_, base.mean_squares);
    std::vector<double> before = base.mean_squares, after = explanation.mean_squares;
    for (std::size_t w = 0; w < looked_at.size(); ++w)
        if (looked_at[w] == 0) before[w] = after[w] = std::numeric_limits<double>::quiet_NaN();
    return total_loss(before) - total_loss(after);
}

void Search::put_real_ones_first(const CrossFit& base, std::span<Contender> all) const {
    const auto is_leader = [](const Contender& contender) { return contender.trial.is_leader; };
    const auto last = std::ranges::find_if_not(all, is_leader);
    std::stable_partition(all.begin(), last,
                          [&](const Contender& leader) { return is_real(base, leader.trial.fitted); });
}

Hypothesis Search::fitted_from_there(const CrossFit& base, const Contender& contender, std::size_t side,
                                     double step_scales) const {
    constexpr int most_iterations = 40;
    constexpr double tolerance = 1e-7;
    const CrossFit& fitted = contender.trial.fitted;
    return fitter_
        .fit_places(side, fitted.of_half[side], contender.fitted_places(base), fitted.mean_squares,
                    {.most_iterations = most_iterations, .tolerance = tolerance, .step_scales = step_scales})
        .hypothesis;
}

Search::Contender Search::crossed(const CrossFit& base, const Contender& contender) const {
    const Places places = contender.fitted_places(base);
    const bool is_wave = contender.trial.candidate->wave.has_value();
    std::array<bool, 2> is_better{};
    Contender from_other = contender;
    for (const std::size_t side : {0, 1}) {
        const Hypothesis &own = contender.trial.fitted.of_half[side],
                         other = with_part(own, places,
                                           part_of(contender.trial.fitted.of_half[1 - side], places));
        is_better[side] = loss_on_half(side, other, *contender.trial.candidate) <
                          loss_on_half(side, own, *contender.trial.candidate) - least_gain;
        if (is_better[side]) from_other.trial.fitted.of_half[side] = other;
    }
    if (!is_better[0] && !is_better[1]) return contender;
    Contender found = from_other;
    parallel_for(2, [&](std::size_t side) {
        if (is_better[side])
            found.trial.fitted.of_half[side] = is_wave
                                                   ? polished(from_other, side, places).hypothesis
                                                   : fitted_from_there(base, from_other, side, close_step);
    });
    judge_both_halves(base, found);
    return found;
}

Search::Contender Search::refined(const CrossFit& base, const Contender& contender) const {
    // Predictions of the Hall reading cost much, and their loss is smooth: some iterations are enough to find
    // the best attempt, and only that is continued.
    const bool shows_in_hall = contender.teachers()[index_of(Signal::hall)];
    constexpr int iterations_in_hall = 10, iterations_elsewhere = 4;
    constexpr std::size_t most_continued = narrow_beam;
    const int first_iterations = shows_in_hall ? iterations_in_hall : iterations_elsewhere;
    const std::size_t most_fitted_on = shows_in_hall ? 1 : most_continued;
    struct Attempt {
        std::size_t added;
        Hypothesis start;
        double loss = 0.0;
        Contender with = {};
    };
    const CrossFit& fitted = contender.trial.fitted;
    const Places places = contender.fitted_places(base);
    std::vector<Attempt> attempts{{0, fitted.of_half[0]}};
    for (const std::vector<Refined>& added : ways_to_refine(fitted.of_half[0], places))
        attempts.push_back({added.size(), with_values(fitted.of_half[0], added)});
    parallel_for(attempts.size(), [&](std::size_t k) {
        Fit first = fitter_.fit_places(0, attempts[k].start, places, fitted.mean_squares,
                                       {.most_iterations = first_iterations});
        attempts[k].start = std::move(first.hypothesis);
        attempts[k].loss = first.loss;
    });
    const double plain = attempts.front().loss;
    std::erase_if(attempts, [&](const Attempt& attempt) {
        return attempt.added == 0 || attempt.loss > plain - least_gain;
    });
    std::ranges::sort(attempts, {}, &Attempt::loss);
    if (attempts.size() > most_fitted_on) attempts.resize(most_fitted_on);
    parallel_for(attempts.size(),
                 [&](std::size_t k) { attempts[k].with = fitted_on(base, contender, attempts[k].start); });
    Contender best = contender;
    std::ranges::stable_sort(attempts, {}, &Attempt::added);
    for (const Attempt& attempt : attempts)
        if (attempt.with.gain() > best.gain() + least_gain) best = attempt.with;
    if (best.gain() == contender.gain()) return contender;
    Contender closest = best;
    parallel_for(2, [&](std::size_t side) {
        closest.trial.fitted.of_half[side] = polished(best, side, places).hypothesis;
    });
    judge_both_halves(base, closest);
    return closest.gain() > best.gain() ? closest : best;
}

Search::Contender Search::fitted_on(const CrossFit& base, const Contender& contender,
                                    const Hypothesis& start) const {
    const Places places = contender.fitted_places(base);
    Contender with = contender;
    Hypothesis found = part_of(start, places);
    for (const std::size_t side : {0, 1}) {
        Hypothesis& hypothesis = with.trial.fitted.of_half[side];
        hypothesis = with_part(std::move(hypothesis), places, found);
        for (const double step_scales : {usual_step, close_step})
            hypothesis = fitted_from_there(base, with, side, step_scales);
        found = part_of(hypothesis, places);
    }
    judge_both_halves(base, with);
    return with;
}

Fit Search::polished(const Contender& contender, std::size_t side, const Places& places) const {
    const std::vector<Window>& windows = fitter_.evidence().windows();
    const Wanted wanted = only_of(windows, fitter_.half(side), contender.teachers());
    return polish(fitter_.predictor(wanted), windows, wanted, contender.trial.fitted.of_half[side], places);
}

double Search::loss_on_half(std::size_t side, const Hypothesis& whole, const Candidate& taught) const {
    const std::vector<Window>& windows = fitter_.evidence().windows();
    const Wanted wanted = only_of(windows, fitter_.half(side), teachers_of(*taught.effect));
    return total_loss(windows, wanted, fitter_.predictor(wanted)(whole));
}

void Search::judge_both_halves(const CrossFit& base, Contender& contender) const {
    Trial& trial = contender.trial;
    fitter_.judge_beside(base, contender.finding->fitted[0], trial.fitted);
    trial.gain = fitter_.compared(base, trial.fitted).gain;
    trial.is_leader = true;
}

}  // namespace fidservo::gap
