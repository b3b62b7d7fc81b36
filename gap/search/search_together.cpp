// SPDX-License-Identifier: GPL-3.0-or-later
// All smooth candidates of wire, sensors and view at once, beside other effects of a base.
#include "gap/balance/balanced_waves.h"
#include "gap/balance/tag_period.h"
#include "gap/search/everything.h"
#include "gap/search/search.h"
#include "gap/starts/shape_screening.h"
#include "gap/starts/starts.h"
#include "plant/effects/catalogue.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {
namespace {

/// Hall reading and tags, as far as there are windows of them.
SignalFlags smooth_signals(std::span<const Window> windows) {
    SignalFlags signals{};
    for (const Window& window : windows)
        if (window.signal == Signal::hall || window.signal == Signal::tag)
            signals[index_of(window.signal)] = true;
    return signals;
}

/// The smooth candidates that are estimated from some signals, one of each class: the one that a hypothesis
/// has, if any.
std::vector<const Candidate*> smooth_ones(const std::vector<Candidate>& all, const Hypothesis& known,
                                          const SignalFlags& signals) {
    const auto is_known = [&](const Candidate& candidate) { return has_effect(known, *candidate.effect); };
    std::vector<const Candidate*> found;
    for (const Candidate& candidate : all) {
        if (!is_smooth(candidate) || !meet(teachers_of(*candidate.effect), signals)) continue;
        const auto same = std::ranges::find(found, candidate.class_name, &Candidate::class_name);
        // Of candidates that no data can distinguish: the one that is known, else the one with the most
        // sizes.
        if (same == found.end())
            found.push_back(&candidate);
        else if (is_known(candidate) || (!is_known(**same) && candidate.sizes.size() > (*same)->sizes.size()))
            *same = &candidate;
    }
    return found;
}

std::set<const plant::Effect*> effects_of(const Hypothesis& hypothesis) {
    std::set<const plant::Effect*> effects;
    for (const plant::EffectSetting& setting : hypothesis) effects.insert(setting.effect);
    return effects;
}

/// Whether a candidate is estimated from the Hall reading, which tells more of it than tags do.
bool is_told_by_hall(const Candidate* candidate) {
    return teachers_of(*candidate->effect)[index_of(Signal::hall)];
}

}  // namespace

/// The candidates that are fitted at once, settings that stay as they are, start values, those candidates'
/// settings in the base, and windows.
struct Search::EverythingBeside {
    std::vector<const Candidate*> candidates;
    std::array<Hypothesis, 2> beside;
    Hypothesis begun, known;
    std::array<Wanted, 2> wanted;
};

Search::EverythingBeside Search::everything_of(const CrossFit& base, SmoothSignals of) const {
    SignalFlags smooth = smooth_signals(fitter_.evidence().windows());
    EverythingBeside everything{
        smooth_ones(candidates_, base.of_half[0], smooth), base.of_half, base.of_half[0], {}, {}};
    if (of == SmoothSignals::tags_alone) {
        std::erase_if(everything.candidates, is_told_by_hall);
        smooth = only(Signal::tag);
    } else if (of == SmoothSignals::hall_alone) {
        std::erase_if(everything.candidates, std::not_fn(is_told_by_hall));
        smooth = only(Signal::hall);
    }
    const auto is_among = [&](const plant::EffectSetting& setting) {
        return std::ranges::find(everything.candidates, setting.effect, &Candidate::effect) !=
               everything.candidates.end();
    };
    for (Hypothesis& hypothesis : everything.beside) std::erase_if(hypothesis, is_among);
    std::erase_if(everything.begun, [&](const plant::EffectSetting& setting) { return !is_among(setting); });
    everything.known = everything.begun;
    for (std::size_t side = 0; side < 2; ++side)
        everything.wanted[side] = only_of(fitter_.evidence().windows(), fitter_.half(side), smooth);
    return everything;
}

void Search::end(Ended how) {
    over_ = how;
    fitter_.evidence().budget()->end_search();
}

Search::Together Search::needed_of(const EverythingBeside& all, IfFar if_far) {
    NeededCandidates needed = needed_of_everything(fitter_.evidence(), all.candidates, all.beside, all.begun,
                                                   all.known, all.wanted, if_far);
    if (needed.ended) end(*needed.ended);
    const bool is_of_one_half = needed.ended && needed.of_half[0] == needed.of_half[1];
    Together found = together(all.beside, std::move(needed));
    found.fitted.is_of_one_half = is_of_one_half;
    return found;
}

Search::Together Search::everything_beside(const CrossFit& base) {
    if (options_.tell) options_.tell("all that is smooth at once");
    const bool is_carriage_off = off(base)[index_of(Signal::encoder)];
    if (!off(base)[index_of(Signal::hall)]) return view_and_wire({{}, {}, base}, is_carriage_off);
    Together of_hall = needed_of(everything_of(base, SmoothSignals::hall_alone), IfFar::gives_up);
    if (of_hall.candidates.empty() && !over_)
        of_hall = from_afar(SmoothSignals::hall_alone, base, Signal::hall);
    if (over_) return of_hall;
    if (of_hall.candidates.empty()) return hall_and_tags(base);
    if (!off(of_hall.fitted)[index_of(Signal::tag)]) return of_hall;
    if (!far_off(of_hall.fitted)[index_of(Signal::hall)])
        return view_and_wire(std::move(of_hall), is_carriage_off);
    Together found = hall_and_tags(of_hall.fitted);
    return found.candidates.empty() ? of_hall : found;
}

Search::Together Search::from_afar(SmoothSignals of, const CrossFit& base, Signal signal) {
    Together shaped = shaped_among(of, base, signal);
    if (over_ || !shaped.candidates.empty()) return shaped;
    return needed_of(everything_of(base, of), IfFar::goes_on);
}

Search::Together Search::view_and_wire(Together of_hall, bool is_of_view_alone) {
    Together found = std::move(of_hall);
    Together of_view = needed_of(everything_of(found.fitted, SmoothSignals::tags_alone), IfFar::gives_up);
    if (of_view.candidates.empty() && !is_of_view_alone && !over_)
        of_view = from_afar(SmoothSignals::tags_alone, found.fitted, Signal::tag);
    if (!of_view.candidates.empty()) {
        std::ranges::move(of_view.candidates, std::back_inserter(found.candidates));
        std::ranges::move(of_view.worth, std::back_inserter(found.worth));
        found.fitted = std::move(of_view.fitted);
    }
    if (over_ || is_of_view_alone || !off(found.fitted)[index_of(Signal::tag)]) return found;
    Together of_both = hall_and_tags(found.fitted);
    return of_both.candidates.empty() ? found : of_both;
}

Search::Together Search::tags_beside(const CrossFit& base) {
    return far_off(base)[index_of(Signal::hall)] ? hall_and_tags(base) : view_and_wire({{}, {}, base}, false);
}

Search::Together Search::hall_and_tags(const CrossFit& base) {
    return needed_of(everything_of(base, SmoothSignals::hall_and_tags), IfFar::gives_up);
}

Hypothesis Search::waves_of_reading(const CrossFit& base,
                                    std::span<const Candidate* const> candidates) const {
    constexpr int phases = 8;
    std::vector<const Candidate*> of_waves;
    std::ranges::copy_if(candidates, std::back_inserter(of_waves),
                         [](const Candidate* candidate) { return candidate->wave.has_value(); });
    const SignalFlags are_off = off(base);
    if (of_waves.empty() || !are_off[index_of(Signal::encoder)]) return {};
    const Evidence& evidence = fitter_.evidence();
    const Hypothesis& known = base.of_half[0];
    const auto errors_of = [&](Signal signal) {
        return evidence.errors(known, only_of(evidence.windows(), fitter_.half(0), only(signal)));
    };
    Hypothesis waves;
    for (const PositionPeriod& period : periods_along_rail(evidence, known, errors_of(Signal::encoder)))
        for (const Candidate* candidate : of_waves) waves.push_back(wave_at(*candidate, period));
    const double of_tags_mm =
        are_off[index_of(Signal::tag)] ? strongest_tag_period_mm(evidence, errors_of(Signal::tag)) : 0.0;
    if (of_tags_mm <= 0.0) return waves;
    for (const Candidate* candidate : of_waves)
        for (int k = 0; k < phases; ++k) {
            plant::EffectSetting& wave = waves.emplace_back(plant::typical_setting(*candidate->effect));
            wave.values[candidate->wave->period] = of_tags_mm;
            wave.values[candidate->wave->phase] = 2.0 * std::numbers::pi * k / phases - std::numbers::pi;
        }
    return waves;
}

Search::Together Search::shaped_beside(const CrossFit& base, Signal signal) {
    return shaped_among(signal == Signal::hall ? SmoothSignals::hall_alone : SmoothSignals::hall_and_tags,
                        base, signal);
}

Search::Together Search::shaped_among(SmoothSignals of, const CrossFit& base, Signal signal) {
    const EverythingBeside all = everything_of(base, of);
    const bool is_of_hall = of == SmoothSignals::hall_alone;
    if (is_of_hall && hall_screened_beside_ == effects_of(all.known)) return {{}, {}, base};
    const Wanted wanted = only_of(fitter_.evidence().windows(), all.wanted[0], only(signal));
    const Hypothesis shapes =
        promising_shapes(fitter_.evidence(), all.candidates, waves_of_reading(base, all.candidates),
                         all.beside[0], all.begun, wanted);
    Together found{{}, {}, base};
    if (!shapes.empty()) found = needed_with(base, all, shapes);
    if (found.candidates.empty() && shapes.size() > 1 && !over_)
        found = needed_with(base, all, {shapes.front()});
    if (!is_of_hall) return found;
    const std::set<const plant::Effect*> needed = effects_of(everything_of(found.fitted, of).known);
    const bool is_any_needed = std::ranges::any_of(
        shapes, [&](const plant::EffectSetting& shape) { return needed.contains(shape.effect); });
    if (!is_any_needed) hall_screened_beside_ = needed;
    return found;
}

Search::Together Search::needed_with(const CrossFit& base, const EverythingBeside& all,
                                     const Hypothesis& shapes) {
    const auto candidate_of = [&](const plant::EffectSetting& setting) {
        return *std::ranges::find(all.candidates, setting.effect, &Candidate::effect);
    };
    std::vector<std::string_view> names;
    bool shows_in_hall = false;
    for (const plant::EffectSetting& shape : shapes) {
        names.push_back(shape.effect->name);
        shows_in_hall = shows_in_hall || is_told_by_hall(candidate_of(shape));
    }
    if (options_.tell) options_.tell(fmt::format("{} with all that is smooth", fmt::join(names, ", ")));
    EverythingBeside with = shows_in_hall ? all : everything_of(base, SmoothSignals::tags_alone);
    // Effects that have stood in for these may hold their fit back: their sizes begin at zero.
    std::erase_if(with.begun,
                  [&](const plant::EffectSetting& setting) { return !has_a_shape(*candidate_of(setting)); });
    with.begun.insert(with.begun.end(), shapes.begin(), shapes.end());
    return needed_of(with, IfFar::goes_on);
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
