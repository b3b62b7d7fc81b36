// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/starts.h"

#include "gap/balance/balanced_springs.h"
#include "gap/balance/balanced_waves.h"
#include "gap/fit/score.h"
#include "gap/starts/wave_starts.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

namespace fidservo::gap {
namespace {

plant::EffectSetting as_found(const FrictionPatch& patch, const Candidate& candidate) {
    plant::EffectSetting setting{candidate.effect, candidate.shapes.front()};
    setting.values[candidate.patch->level] = patch.level_V;
    setting.values[candidate.patch->centre] = patch.centre_mm;
    setting.values[candidate.patch->width] = patch.width_mm;
    return setting;
}

/// The candidate with the places of some patches added to its grid.
Candidate with_shapes(Candidate candidate, std::span<const FrictionPatch> patches) {
    const std::vector<double> typical = candidate.shapes.front();
    for (const FrictionPatch& patch : patches) {
        std::vector<double> shape = typical;
        shape[candidate.patch->centre] = patch.centre_mm;
        shape[candidate.patch->width] = patch.width_mm;
        candidate.shapes.push_back(std::move(shape));
    }
    return candidate;
}

std::vector<Promise> patches_at_first_sight(const Predict& predict, std::span<const Window> windows,
                                            const Wanted& counted, const Surroundings& beside,
                                            const Candidate& candidate,
                                            std::span<const FrictionPatch> patches) {
    std::vector<Promise> starts =
        at_first_sight(predict, windows, counted, beside, with_shapes(candidate, patches));
    if (starts.empty()) return starts;
    const std::vector<double> base_squares = mean_squares(windows, beside.errors);
    for (const FrictionPatch& patch : patches)
        starts.push_back(
            promise_of(as_found(patch, candidate), predict, windows, counted, beside, base_squares));
    std::ranges::sort(starts, std::greater{}, &Promise::gain);
    return starts;
}

/// What each of the settings_within_counts() promises.
std::vector<Promise> scanned(const Predict& predict, std::span<const Window> windows, const Wanted& counted,
                             const Surroundings& beside, const Candidate& candidate) {
    const std::vector<double> base_squares = mean_squares(windows, beside.errors);
    std::vector<Promise> starts;
    for (plant::EffectSetting& setting : settings_within_counts(candidate))
        starts.push_back(promise_of(std::move(setting), predict, windows, counted, beside, base_squares));
    return starts;
}

/// The best of both, without those that gain nothing.
std::vector<Promise> best_of(std::vector<Promise> starts, std::vector<Promise> more) {
    std::ranges::move(more, std::back_inserter(starts));
    std::ranges::sort(starts, std::greater{}, &Promise::gain);
    std::erase_if(starts, [](const Promise& start) { return start.gain <= 0.0; });
    if (starts.size() > most_starts) starts.resize(most_starts);
    return starts;
}

}  // namespace

std::vector<PositionPeriod> periods_along_rail(const Evidence& evidence, const Hypothesis& known,
                                               const Errors& errors) {
    return on_the_rail(strongest_periods(evidence, errors), evidence.rig(), known);
}

AlongRail seen_along_rail(const Evidence& evidence, const Hypothesis& known, const Wanted& wanted,
                          std::span<const Candidate* const> candidates) {
    const bool asks_for_periods =
        std::ranges::any_of(candidates, [](const Candidate* c) { return c->wave.has_value(); });
    const bool asks_for_patches =
        std::ranges::any_of(candidates, [](const Candidate* c) { return c->patch.has_value(); });
    const bool asks_for_springs =
        std::ranges::any_of(candidates, [](const Candidate* c) { return is_spring(*c->effect); });
    if (!asks_for_periods && !asks_for_patches && !asks_for_springs) return {};
    const Errors errors = evidence.errors(known, wanted);
    AlongRail along;
    if (asks_for_periods) along.periods = periods_along_rail(evidence, known, errors);
    for (const Candidate* candidate : candidates) {
        std::ranges::move(balanced_waves(evidence, wanted, known, *candidate, along.periods),
                          std::back_inserter(along.balanced));
        std::ranges::move(balanced_springs(evidence, wanted, known, *candidate),
                          std::back_inserter(along.balanced));
    }
    if (asks_for_patches) along.patches = strongest_patches(evidence, errors);
    return along;
}

std::vector<Promise> starts_of(const Candidate& candidate, const AlongRail& along, const Predict& predict,
                               std::span<const Window> windows, const Wanted& counted,
                               const Surroundings& beside) {
    if (candidate.wave)
        return waves_at_first_sight(predict, windows, counted, beside, candidate, along.periods,
                                    along.balanced);
    if (candidate.patch)
        return patches_at_first_sight(predict, windows, counted, beside, candidate, along.patches);
    std::vector<Promise> starts = at_first_sight(predict, windows, counted, beside, candidate);
    if (candidate.step_within_counts != 0.0)
        return best_of(std::move(starts), scanned(predict, windows, counted, beside, candidate));
    const std::vector<double> base_squares = mean_squares(windows, beside.errors);
    std::vector<Promise> of_balance;
    for (const plant::EffectSetting& setting : along.balanced)
        if (setting.effect == candidate.effect)
            of_balance.push_back(promise_of(setting, predict, windows, counted, beside, base_squares));
    return of_balance.empty() ? starts : best_of(std::move(starts), std::move(of_balance));
}

}  // namespace fidservo::gap
