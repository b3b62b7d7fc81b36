// SPDX-License-Identifier: GPL-3.0-or-later
// An explanation of the carriage by a model from the balance of its forces.
#include "core/parallel.h"
#include "core/rig.h"
#include "gap/balance/balance_fit.h"
#include "gap/balance/force_regression.h"
#include "gap/evidence/halves.h"
#include "gap/fit/polish.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"
#include "gap/search/everything.h"
#include "gap/search/search.h"
#include "gap/starts/scatter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace fidservo::gap {
namespace {

std::size_t place_of_least(const std::vector<double>& values) {
    return static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
}

/// A setting as it is, with each value of each optional parameter, and with each other choice.
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
        if (parameter.is_choice())
            add(k, parameter.is_high(setting.values[k]) ? parameter.low : parameter.high);
    }
    return all;
}

/// A model as it is, and its variants in which one effect has another form: simpler, richer, with an optional
/// parameter, or with another choice. The balance does not tell these apart, as it contains nothing about a
/// carriage that stands.
std::vector<BalancedModel> forms_of(const BalancedModel& model, const std::vector<Candidate>& candidates,
                                    const MacroParameters& rail) {
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
        for (const Candidate& other : candidates) {
            if (std::ranges::find(model.candidates, &other) != model.candidates.end()) continue;
            for (const plant::EffectSetting& form : rich_forms(model.settings[at], other)) add(other, form);
            if (is_limit_of(*other.effect, *model.candidates[at]->effect) && !other.is_limit)
                add(other, plain_form(model.settings[at], rail));
        }
    }
    return forms;
}

/// A model's candidates, followed by other forces without a place that are neither forms of one of these nor
/// of each other. A late command, which has no shape either, is no force: it is looked for like play and a
/// belt, for which it can stand in.
std::vector<const Candidate*> smooth_beside(const BalancedModel& model,
                                            const std::vector<Candidate>& candidates, const Rig& rig) {
    std::vector<const Candidate*> all = model.candidates;
    for (const Candidate& candidate : candidates) {
        const auto is_a_form = [&](const Candidate* other) {
            return other->class_name == candidate.class_name ||
                   is_limit_of(*other->effect, *candidate.effect) ||
                   is_limit_of(*candidate.effect, *other->effect);
        };
        if (is_smooth_of_carriage(candidate) && is_force(rig, candidate) &&
            std::ranges::none_of(all, is_a_form))
            all.push_back(&candidate);
    }
    return all;
}

/// One half of the encoder's windows, predicted by simulating the carriage with a model's effects in addition
/// to known ones.
class FollowedHalf {
  public:
    FollowedHalf(const Evidence& evidence, const Hypothesis& known, const Wanted& wanted)
        : evidence_(evidence), known_(known), wanted_(wanted), predict_(predictor(wanted)) {}

    double loss(const Hypothesis& settings) const {
        return total_loss(evidence_.windows(), wanted_, predict_(settings));
    }

    std::vector<double> losses(const std::vector<BalancedModel>& models) const {
        std::vector<double> losses(models.size());
        parallel_for(models.size(), [&](std::size_t k) { losses[k] = loss(models[k].settings); });
        return losses;
    }

    Fit fitted(const Hypothesis& settings) const {
        return fit(predict_, evidence_.windows(), wanted_, settings);
    }

    /// The best of many values drawn around some settings, because the loss of forces along the rail has many
    /// local minima.
    /// @param windows  how many windows are predicted
    Hypothesis scattered(const Hypothesis& settings, std::size_t windows) const {
        constexpr double spread = 0.25;  // the balance of forces is a much better start than a guess
        Places all(settings.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        const std::vector<Window>& from = evidence_.windows();
        const Wanted telling = instructive(from, wanted_, mean_squares(from, predict_(settings)), windows);
        const Fit drawn = scatter(predictor(telling), from, telling, settings, all, spread);
        return polish(predictor(telling), from, telling, drawn.hypothesis, all).hypothesis;
    }

    /// The first of some forms of a model, fitted; or the best of those others that have the least loss
    /// before a fit, if its lead after the fit is more than chance.
    BalancedModel best_form(std::vector<BalancedModel> forms, double tail) const {
        const double chance = std::log(static_cast<double>(forms.size()) / tail);
        const std::vector<double> unfitted = losses(forms);
        std::vector<std::size_t> order(forms.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order.begin() + 1, order.end(), {},
                                 [&](std::size_t form) { return unfitted[form]; });
        order.resize(std::min(order.size(), most_fitted_forms));
        std::vector<double> left(order.size());
        parallel_for(order.size(), [&](std::size_t k) {
            Fit closer = fitted(forms[order[k]].settings);
            forms[order[k]].settings = std::move(closer.hypothesis);
            left[k] = closer.loss;
        });
        const std::size_t least = place_of_least(left);
        return forms[order[left[least] < left.front() - chance ? least : 0]];
    }

    /// Loss that each effect of a model saves beside the others, without another fit.
    std::vector<double> worth(const Hypothesis& settings) const {
        const double with_all = loss(settings);
        std::vector<double> worth;
        for (std::size_t k = 0; k < settings.size(); ++k) {
            Hypothesis without = settings;
            without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
            worth.push_back(loss(without) - with_all);
        }
        return worth;
    }

  private:
    Predict predictor(const Wanted& wanted) const {
        return [this, &wanted](const Hypothesis& settings) {
            Hypothesis whole = known_;
            whole.insert(whole.end(), settings.begin(), settings.end());
            return evidence_.errors(whole, wanted);
        };
    }

    const Evidence& evidence_;
    const Hypothesis& known_;
    const Wanted& wanted_;
    Predict predict_;
};

/// Settings for both halves, each drawn around those of the two halves' settings that predict it better: the
/// other half may have found a deeper minimum.
std::array<Hypothesis, 2> drawn_around(const FollowedHalf& first, const FollowedHalf& second,
                                       const std::array<Hypothesis, 2>& settings, std::size_t windows) {
    const auto of = [&](const FollowedHalf& half, const Hypothesis& own, const Hypothesis& other) {
        return half.scattered(half.loss(other) < half.loss(own) ? other : own, windows);
    };
    return {of(first, settings[0], settings[1]), of(second, settings[1], settings[0])};
}

}  // namespace

bool Search::is_force(const Candidate& candidate) const {
    return gap::is_force(fitter_.evidence().rig(), candidate);
}

Search::Together Search::forces_beside(const CrossFit& base) {
    const Evidence& evidence = fitter_.evidence();
    const double effort_before = evidence.effort();
    if (options_.tell) options_.tell("what balances the carriage's forces");
    Together found = balanced_beside(base);
    effort_at_start_ += evidence.effort() - effort_before;
    return found;
}

Search::Together Search::balanced_beside(const CrossFit& base) const {
    const auto settings_of_model = [&](const Together& found) {
        std::array<Hypothesis, 2> settings = found.fitted.of_half;
        for (std::size_t side = 0; side < 2; ++side)
            settings[side].erase(
                settings[side].begin(),
                settings[side].begin() + static_cast<std::ptrdiff_t>(base.of_half[side].size()));
        return settings;
    };
    constexpr std::size_t most_drawn = 3;  // effects; with more, a generation has too few draws
    const Evidence& evidence = fitter_.evidence();
    std::vector<const Candidate*> all;
    for (const Candidate& candidate : candidates_) all.push_back(&candidate);
    const std::vector<BalancedModel> models =
        balanced_models(evidence, fitter_.half(1), moving_carriage(base.of_half[0]), all, options_.tail);
    if (models.empty()) return {{}, {}, base};
    std::array<Wanted, 2> wanted;
    for (std::size_t side = 0; side < 2; ++side)
        wanted[side] = only_of(evidence.windows(), fitter_.half(side), only(Signal::encoder));
    const FollowedHalf first(evidence, base.of_half[0], wanted[0]),
        second(evidence, base.of_half[1], wanted[1]);
    std::optional<Together> best;
    try {
        const Budget::Share share(*evidence.budget(), half_of_it);
        BalancedModel model = models[place_of_least(first.losses(models))];
        best = together(base.of_half,
                        {model.candidates, {model.settings, model.settings}, first.worth(model.settings)});
        model = first.best_form(forms_of(model, candidates_, evidence.rig().macro), options_.tail);
        NeededCandidates itself{model.candidates,
                                {model.settings, second.fitted(model.settings).hypothesis},
                                first.worth(model.settings)};
        best = together(base.of_half, itself);
        const auto is_off = [&] { return off(best->fitted)[index_of(Signal::encoder)]; };
        const bool is_in_valleys = itself.candidates.size() <= most_drawn &&
                                   std::ranges::any_of(itself.candidates, [](const Candidate* candidate) {
                                       return has_valleys(*candidate);
                                   });
        for (int round = 0; is_in_valleys && is_off() && round < most_rounds; ++round) {
            itself.of_half = drawn_around(first, second, settings_of_model(*best), options_.windows);
            itself.worth = first.worth(itself.of_half[0]);
            Together drawn = together(base.of_half, itself);
            if (!(drawn.fitted.loss < best->fitted.loss)) break;
            best = std::move(drawn);
            if (!(best->fitted.loss < base.loss)) return {{}, {}, base};
        }
        if (!is_off()) return *best;
        Together whole = together(
            base.of_half,
            needed_of_everything(evidence, smooth_beside(model, candidates_, evidence.rig()), base.of_half,
                                 settings_of_model(*best)[0], {}, wanted, IfFar::goes_on));
        // Many effects that leave most of the gap stand in for something else.
        const bool explains = nearly_clears(base, whole.fitted, nearly_all);
        return explains && whole.fitted.loss < best->fitted.loss ? whole : *best;
    } catch (const ShareEnded&) {
    } catch (const BudgetEnded&) {
        if (!best) throw;
    }
    return best ? *best : Together{{}, {}, base};
}

}  // namespace fidservo::gap
