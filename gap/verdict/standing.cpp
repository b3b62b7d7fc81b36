// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/verdict/standing.h"

#include "gap/fit/gap_size.h"
#include "gap/numbers.h"
#include "gap/residuals/accusation.h"
#include "gap/verdict/calibration.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace fidservo::gap {
namespace {

/// See Support::is_contested.
bool is_contested(const std::optional<Remainder>& whole, const Selection& selection, const Choice& choice) {
    if (!whole || whole->depends_on.size() != 1 || stage_of(whole->block) != Stage::camera ||
        !shows_in_view(*choice.candidate->effect))
        return false;
    return std::ranges::none_of(selection.choices, [&](const Choice& named) {
        return named.candidate->effect->block == whole->block;
    });
}

/// Whether one of its sizes is at a bound, or a shape at the largest value that is tried. The smallest value
/// of a shape is what is physically possible: a limiting case of the effect.
bool is_at_bound(const Candidate& candidate, const plant::EffectSetting& setting) {
    const std::span<const plant::EffectParameter> parameters = setting.effect->parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        const double value = setting.values[k];
        if (parameters[k].is_choice() || value == parameters[k].vanishing) continue;
        const bool is_size = std::ranges::find(candidate.sizes, k) != candidate.sizes.end();
        if (value == parameters[k].high || (is_size && value == parameters[k].low)) return true;
    }
    return false;
}

/// Of all its sizes together, in typical ones or, of what has none, in their ranges, over what they are away
/// from none.
double halves_apart(const Candidate& candidate, const plant::EffectSetting& one,
                    const plant::EffectSetting& other) {
    double difference = 0.0, size = 0.0;
    for (const std::size_t k : candidate.sizes) {
        const plant::EffectParameter& parameter = candidate.effect->parameters[k];
        const bool has_typical_size = parameter.typical != parameter.vanishing;
        const double scale =
            has_typical_size ? parameter.typical - parameter.vanishing : parameter.high - parameter.low;
        difference += std::pow((one.values[k] - other.values[k]) / scale, 2);
        size += std::pow((0.5 * (one.values[k] + other.values[k]) - parameter.vanishing) / scale, 2);
    }
    return size > 0.0 ? std::sqrt(difference / size) : 0.0;
}

/// The setting of a candidate's effect in a hypothesis; null where it has none.
const plant::EffectSetting* setting_of(const Candidate& candidate, const Hypothesis& hypothesis) {
    const auto found = std::ranges::find(hypothesis, candidate.effect, &plant::EffectSetting::effect);
    return found == hypothesis.end() ? nullptr : &*found;
}

/// The same in a cross fit, of which the second half may not have been fitted.
double halves_apart(const Candidate& candidate, const CrossFit& fitted) {
    constexpr double is_not_shown = 1.0;  // that the halves agree
    const plant::EffectSetting* const one = setting_of(candidate, fitted.of_half[0]);
    const plant::EffectSetting* const other = setting_of(candidate, fitted.of_half[1]);
    const bool are_two = one != nullptr && other != nullptr && !fitted.is_of_one_half;
    return are_two ? halves_apart(candidate, *one, *other) : is_not_shown;
}

bool is_at_bound(const Candidate& candidate, const CrossFit& fitted) {
    return std::ranges::any_of(fitted.of_half, [&](const Hypothesis& half) {
        const plant::EffectSetting* const setting = setting_of(candidate, half);
        return setting != nullptr && is_at_bound(candidate, *setting);
    });
}

/// What is left, and what would be without one of them, in that of its signals in which it matters most.
struct OwnFloors {
    double left = 1.0, without = 1.0;
};

using Floors = std::array<double, signal_count>;

OwnFloors own_floors(const Floors& left, const Floors& without, const SignalFlags& taught) {
    OwnFloors most;
    for (std::size_t s = 0; s < signal_count; ++s)
        if (taught[s] && without[s] / left[s] >= most.without / most.left) most = {left[s], without[s]};
    return most;
}

/// The weight of what has it, or what these recordings cannot tell from it.
double weight_of_name(const Choice& choice, const ChoiceWeights& weights) {
    double sum = 0.0;
    for (std::size_t k = 0; k < choice.alternatives.size(); ++k) {
        const Candidate* candidate = choice.alternatives[k].candidate;
        if (candidate->class_name == choice.candidate->class_name ||
            std::ranges::find(choice.ties, candidate) != choice.ties.end())
            sum += weights.of_alternatives[k];
    }
    return std::min(1.0, sum);
}

}  // namespace

bool shows_in_view(const plant::Effect& effect) {
    return stage_of(effect.block) == Stage::camera || effect.part == plant::Part::encoder;
}

Features features_of(const Support& support) {
    constexpr double most_logit = 7.0, least_share = 1e-4, least_apart = next_to_none,
                     least_floors_off = 0.15, most_floors_off = 3.0;
    const auto log_discrepancy = [&](double floors) {
        const double discrepancy = std::sqrt(std::max(0.0, std::pow(floors, 2) - 1.0));
        return -std::log(std::clamp(discrepancy, least_floors_off, most_floors_off));
    };
    const double odds = support.weight / std::max(1.0 - support.weight, least_positive);
    return {std::clamp(std::log(std::max(odds, least_positive)), -most_logit, most_logit),
            log_discrepancy(support.gap_after),
            log_discrepancy(support.left_floors),
            std::log(support.without_floors / support.left_floors),
            -std::log(std::max(support.gap_left, least_share)),
            std::log(support.names),
            -std::log(std::max(support.halves_apart, least_apart)),
            support.leaves_something ? 0.0 : 1.0,
            support.leaves_dependence ? 0.0 : 1.0};
}

double logistic_probability(const Features& features, double offset, const Features& coefficients) {
    double log_odds = offset;
    for (std::size_t k = 0; k < features.size(); ++k) log_odds += coefficients[k] * features[k];
    return 1.0 / (1.0 + std::exp(-log_odds));
}

bool has_a_rival(const Support& support) {
    return support.is_contested || support.is_at_bound;
}

double calibrated_probability(const Support& support) {
    constexpr double share_of_two = 0.5;
    const double probability =
        logistic_probability(features_of(support), calibrated_offset, calibrated_coefficients);
    return has_a_rival(support) ? share_of_two * probability : probability;
}

std::vector<Support> supports(const Evidence& evidence, const Selection& selection,
                              const std::vector<ChoiceWeights>& weights, const SignalsLeft& left,
                              const std::optional<Remainder>& whole) {
    const std::vector<Window>& windows = evidence.windows();
    const CrossFit& explained = selection.steps.back();
    const TotalGap gap =
        total_gap(signal_gaps(evidence, selection.steps.front().mean_squares, explained.mean_squares));
    const Floors floors = typical_floors(windows, explained.mean_squares);
    std::vector<Support> all;
    for (std::size_t k = 0; k < selection.choices.size(); ++k) {
        const Choice& choice = selection.choices[k];
        const CrossFit& left_out =
            choice.left_out.mean_squares.empty() ? selection.steps.front() : choice.left_out;
        const Floors without = typical_floors(windows, left_out.mean_squares);
        const SignalFlags teachers = teachers_of(*choice.candidate->effect);
        const OwnFloors own = own_floors(floors, without, teachers);
        all.push_back({.weight = weight_of_name(choice, weights[k]),
                       .left_floors = own.left,
                       .without_floors = own.without,
                       .gap_alone = choice.gap_alone,
                       .gap_after = gap.after,
                       .gap_left = 1.0 - gap.removed(),
                       .names = static_cast<double>(selection.choices.size()),
                       .halves_apart = halves_apart(*choice.candidate, explained),
                       .is_at_bound = is_at_bound(*choice.candidate, explained),
                       .leaves_something = meet(left.off, teachers),
                       .leaves_dependence = meet(left.dependent, teachers),
                       .is_contested = is_contested(whole, selection, choice)});
    }
    return all;
}

Support support_alone(const Evidence& evidence, const Trial& trial, const CrossFit& nothing, double weight,
                      const TotalGap& gap) {
    const CrossFit& fitted = trial.fitted;
    const SignalFlags teachers = teachers_of(*trial.candidate->effect);
    const OwnFloors own = own_floors(typical_floors(evidence.windows(), fitted.mean_squares),
                                     typical_floors(evidence.windows(), nothing.mean_squares), teachers);
    const SignalFlags left = signals_left(signal_gaps(evidence, nothing.mean_squares, fitted.mean_squares));
    return {.weight = weight,
            .left_floors = own.left,
            .without_floors = own.without,
            .gap_alone = gap.before,
            .gap_after = gap.after,
            .gap_left = 1.0 - gap.removed(),
            .names = 1.0,
            .halves_apart = halves_apart(*trial.candidate, fitted),
            .is_at_bound = is_at_bound(*trial.candidate, fitted),
            .leaves_something = meet(left, teachers),
            .leaves_dependence = meet(left, teachers),
            .is_contested = false};
}

}  // namespace fidservo::gap
