// All smooth candidates at once: of wire and view beside what is known of the carriage, and of the carriage
// from where its forces balance.
#include "core/rig.h"
#include "gap/everything.h"
#include "gap/force_regression.h"
#include "gap/halves.h"
#include "gap/parallel.h"
#include "gap/score.h"
#include "gap/search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fidservo::gap {
namespace {

/// One smooth candidate of each class, that which a hypothesis has if it has one.
std::vector<const Candidate*> smooth_ones(const std::vector<Candidate>& all, const Hypothesis& known) {
    const auto is_known = [&](const Candidate& candidate) {
        return std::ranges::find(known, candidate.effect, &plant::EffectSetting::effect) != known.end();
    };
    std::vector<const Candidate*> found;
    for (const Candidate& candidate : all) {
        if (!is_smooth(candidate)) continue;
        const auto same = std::ranges::find(found, candidate.class_name, &Candidate::class_name);
        if (same == found.end())
            found.push_back(&candidate);
        else if (is_known(candidate))
            *same = &candidate;
    }
    return found;
}

/// What moves the carriage.
Hypothesis moving_carriage(Hypothesis hypothesis) {
    std::erase_if(hypothesis, [](const plant::EffectSetting& setting) {
        return !teachers_of(*setting.effect)[index_of(Signal::encoder)];
    });
    return hypothesis;
}

std::size_t place_of_least(const std::vector<double>& values) {
    return static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
}

/// A setting, and with each refinement that its effect may have, and each other choice.
std::vector<plant::EffectSetting> with_refinements(const plant::EffectSetting& setting) {
    std::vector<plant::EffectSetting> all{setting};
    const auto add = [&](std::size_t parameter, double value) {
        all.push_back(setting);
        all.back().values[parameter] = value;
    };
    for (const Refinement& refinement : refinements_of(*setting.effect))
        for (const double value : refinement.values) add(refinement.parameter, value);
    for (std::size_t k = 0; k < setting.values.size(); ++k) {
        const plant::EffectParameter& parameter = setting.effect->parameters[k];
        if (parameter.is_choice)
            add(k, parameter.is_high(setting.values[k]) ? parameter.low : parameter.high);
    }
    return all;
}

/// A model as it is, and with one of its effects in another form: richer, or refined. The balance does not
/// see how a carriage stands.
std::vector<BalancedModel> forms_of(const BalancedModel& model, const std::vector<Candidate>& candidates) {
    std::vector<BalancedModel> forms{model};
    for (std::size_t at = 0; at < model.settings.size(); ++at) {
        const auto add = [&](const Candidate& candidate, const plant::EffectSetting& plain) {
            for (plant::EffectSetting& setting : with_refinements(plain)) {
                forms.push_back(model);
                forms.back().candidates[at] = &candidate;
                forms.back().settings[at] = std::move(setting);
            }
        };
        add(*model.candidates[at], model.settings[at]);
        for (const Candidate& richer : candidates)
            if (std::ranges::find(model.candidates, &richer) == model.candidates.end())
                for (const plant::EffectSetting& form : rich_forms(model.settings[at], richer))
                    add(richer, form);
    }
    return forms;
}

/// A model's candidates, and what else is smooth and is neither a form of one of these nor of another.
std::vector<const Candidate*> smooth_beside(const Rig& rig, const BalancedModel& model,
                                            const std::vector<Candidate>& candidates) {
    std::vector<const Candidate*> all = model.candidates;
    for (const Candidate& candidate : candidates) {
        const auto is_a_form = [&](const Candidate* other) {
            return other->class_name == candidate.class_name ||
                   is_limit_of(other->effect->name, candidate.effect->name) ||
                   is_limit_of(candidate.effect->name, other->effect->name);
        };
        if (is_smooth_of_carriage(rig, candidate) && std::ranges::none_of(all, is_a_form))
            all.push_back(&candidate);
    }
    return all;
}

}  // namespace

Search::Together Search::everything_beside(const CrossFit& base) const {
    constexpr SignalFlags smooth{false, true, true, false, false, false};
    const std::vector<const Candidate*> all = smooth_ones(candidates_, base.of_half[0]);
    const auto is_among = [&](const plant::EffectSetting& setting) {
        return std::ranges::find(all, setting.effect, &Candidate::effect) != all.end();
    };
    const Evidence& evidence = fitter_.evidence();
    std::array<Hypothesis, 2> beside = base.of_half;
    for (Hypothesis& hypothesis : beside) std::erase_if(hypothesis, is_among);
    Hypothesis begun = base.of_half[0];
    std::erase_if(begun, [&](const plant::EffectSetting& setting) { return !is_among(setting); });
    std::array<Wanted, 2> wanted;
    for (std::size_t side = 0; side < 2; ++side)
        wanted[side] = only_of(evidence.windows(), fitter_.half(side), smooth);
    return together(beside, needed_of_everything(evidence, all, beside, begun, wanted));
}

Search::Together Search::forces_beside(const CrossFit& base) const {
    const Evidence& evidence = fitter_.evidence();
    const std::vector<Window>& windows = evidence.windows();
    std::vector<const Candidate*> all;
    for (const Candidate& candidate : candidates_) all.push_back(&candidate);
    const std::vector<BalancedModel> models =
        balanced_models(evidence, halves(evidence), moving_carriage(base.of_half[0]), all, options_.tail);
    if (models.empty()) return {{}, {}, base};
    std::array<Wanted, 2> wanted;
    for (std::size_t side = 0; side < 2; ++side)
        wanted[side] = only_of(windows, fitter_.half(side), only(Signal::encoder));
    const Predict predict = [&](const Hypothesis& settings) {
        Hypothesis whole = base.of_half[0];
        whole.insert(whole.end(), settings.begin(), settings.end());
        return evidence.errors(whole, wanted[0]);
    };
    const auto losses_of = [&](const std::vector<BalancedModel>& some) {
        std::vector<double> losses(some.size());
        parallel_for(some.size(), [&](std::size_t k) {
            losses[k] = total_loss(windows, wanted[0], predict(some[k].settings));
        });
        return losses;
    };
    const auto best_form = [&](const BalancedModel& plain) {
        constexpr std::size_t most_fitted = 4;
        std::vector<BalancedModel> forms = forms_of(plain, candidates_);
        const double chance = std::log(static_cast<double>(forms.size()) / options_.tail);
        const std::vector<double> losses = losses_of(forms);
        std::vector<std::size_t> order(forms.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order.begin() + 1, order.end(), {},
                                 [&](std::size_t f) { return losses[f]; });
        order.resize(std::min(order.size(), most_fitted));
        std::vector<double> fitted(order.size());
        parallel_for(order.size(), [&](std::size_t k) {
            Fit closer = fit(predict, windows, wanted[0], forms[order[k]].settings);
            forms[order[k]].settings = std::move(closer.hypothesis);
            fitted[k] = closer.loss;
        });
        const std::size_t least = place_of_least(fitted);
        return forms[order[fitted[least] < fitted.front() - chance ? least : 0]];
    };
    const auto fitted_alone = [&](const BalancedModel& model) {
        const Predict other = [&](const Hypothesis& settings) {
            Hypothesis whole = base.of_half[1];
            whole.insert(whole.end(), settings.begin(), settings.end());
            return evidence.errors(whole, wanted[1]);
        };
        NeededCandidates alone{model.candidates, {model.settings, model.settings}, {}};
        alone.of_half[1] = fit(other, windows, wanted[1], model.settings).hypothesis;
        const double loss = total_loss(windows, wanted[0], predict(model.settings));
        for (std::size_t k = 0; k < model.settings.size(); ++k) {
            Hypothesis without = model.settings;
            without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
            alone.worth.push_back(2.0 * (total_loss(windows, wanted[0], predict(without)) - loss));
        }
        return alone;
    };
    const BalancedModel form = best_form(models[place_of_least(losses_of(models))]);
    const Together alone = together(base.of_half, fitted_alone(form));
    if (!off(alone.fitted)[index_of(Signal::encoder)]) return alone;
    return together(base.of_half,
                    needed_of_everything(evidence, smooth_beside(evidence.rig(), form, candidates_),
                                         base.of_half, form.settings, wanted));
}

Search::Together Search::together(const std::array<Hypothesis, 2>& beside, NeededCandidates needed) const {
    Together together{
        std::move(needed.candidates), std::move(needed.worth), {.of_half = beside, .mean_squares = {}}};
    for (std::size_t side = 0; side < 2; ++side)
        together.fitted.of_half[side].insert(together.fitted.of_half[side].end(),
                                             needed.of_half[side].begin(), needed.of_half[side].end());
    fitter_.judge(together.fitted);
    return together;
}

}  // namespace fidservo::gap
