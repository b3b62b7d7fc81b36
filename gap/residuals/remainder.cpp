// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/remainder.h"

#include "gap/balance/carriage_forces.h"
#include "gap/balance/period_search.h"
#include "gap/evidence/halves.h"
#include "gap/fit/gap_size.h"
#include "gap/residuals/accusation.h"
#include "gap/residuals/held_carriage.h"
#include "gap/residuals/minor_loops.h"
#include "gap/residuals/sheared_tags.h"
#include "gap/residuals/surrogate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::gap {
namespace {

/// What is above this is a gap, whether or not anything is found that it depends on.
constexpr double clear_floors = 1.25;

/// How much more chance is put up with where something must be found.
constexpr double likely = 10.0;

/// Errors of what was fitted on the other half, where they are judged.
Errors held_out_errors(const Evidence& evidence, const CrossFit& explained,
                       std::span<const std::uint8_t> half) {
    const Wanted wanted = everything(evidence);
    Errors errors = evidence.errors(explained.of_half[1], wanted);
    const Errors other = evidence.errors(explained.of_half[0], wanted);
    constexpr float not_judged = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t w = 0; w < half.size(); ++w)
        for (std::size_t k = evidence.windows()[w].begin; k < evidence.windows()[w].end; ++k)
            if (std::isnan(explained.mean_squares[w]))
                errors[k] = not_judged;
            else if (half[w] == 1)
                errors[k] = other[k];
    return errors;
}

/// Groups of the signal's surrogate that predict what was not fitted, and the surrogate's period.
struct Dependences {
    std::vector<int> groups;
    double period_mm = 0.0;
};

/// A surrogate fitted to the errors, that may be asked with several tails.
struct Model {
    Regression regression;
    double as_good;
    double period_mm;

    Dependences dependences(double tail) const {
        return {regression.significant_groups(tail, as_good), period_mm};
    }
};

/// @param errors, windows  that the surrogate is to explain
Model model_of(const Surrogate& surrogate, const Errors& errors, const std::vector<Window>& windows,
               std::span<const std::uint8_t> half) {
    return {Regression(windows, surrogate.signal, errors, surrogate.columns, surrogate.nuisances, half),
            surrogate.as_good, surrogate.period_mm};
}

/// Of a surrogate with errors and windows of its own.
Model model_of(const Surrogate& surrogate, std::span<const std::uint8_t> half) {
    return model_of(surrogate, surrogate.errors, surrogate.windows, half);
}

/// By the first tail that finds any.
Dependences first_found(const Model& model, std::span<const double> tails) {
    Dependences found;
    for (const double tail : tails) {
        found = model.dependences(tail);
        if (!found.groups.empty()) break;
    }
    return found;
}

/// What friction does where the carriage hardly moves shows at the edge of the dead zone only: it is looked
/// for there where nothing is found elsewhere, and at last where the carriage is held though it is pushed.
Dependences dependences_of_carriage(const Evidence& evidence, const Errors& errors,
                                    std::span<const std::uint8_t> usual_half, std::span<const double> tails) {
    const std::vector<std::uint8_t> half = has_own_zeros(evidence)
                                               ? halves_of_each_run(evidence)
                                               : std::vector(usual_half.begin(), usual_half.end());
    const std::vector<PositionPeriod> periods = strongest_periods(evidence, errors);
    const PositionPeriod period = periods.empty() ? PositionPeriod{} : periods.front();
    constexpr std::array edges_V{usual_edge_V, 0.0};
    std::vector<Model> models;
    Dependences found;
    for (const double tail : tails) {
        for (std::size_t k = 0; k < edges_V.size(); ++k) {
            if (k == models.size())
                models.push_back(model_of(carriage_surrogate(evidence, errors, edges_V[k], period), half));
            found = models[k].dependences(tail);
            if (!found.groups.empty()) return found;
        }
        if (!carriage_is_held(evidence)) continue;
        found.groups = {static_cast<int>(Dependence::standing)};
        return found;
    }
    return found;
}

/// @param tails  of finding something by chance, each larger than the one before
Dependences dependences(const Evidence& evidence, Signal signal, const Errors& errors,
                        std::span<const std::uint8_t> half, std::span<const double> tails) {
    switch (signal) {
        case Signal::encoder:
            return dependences_of_carriage(evidence, errors, half, tails);
        case Signal::hall:
            if (only_minor_loops_are_off(evidence, errors))
                return {{static_cast<int>(Dependence::minor_loops)}};
            return first_found(model_of(platform_surrogate(evidence, errors), half), tails);
        case Signal::tag:
            if (tags_are_sheared(evidence, errors)) return {{static_cast<int>(Dependence::motion_by_row)}};
            return first_found(model_of(tag_surrogate(evidence, errors), errors, evidence.windows(), half),
                               tails);
        case Signal::macro_command:
        case Signal::micro_command:
        case Signal::image:
            break;
    }
    return {};
}

/// The beginning of a remainder's text.
std::string what_remains(const SignalGap& gap, const Pattern& pattern) {
    return fmt::format("{}: {:.3g} {} r.m.s. ({:.3g} floors) remain that no effect explains; ",
                       name_of(gap.signal), gap.after, unit_of(gap.signal),
                       pattern.floors[index_of(gap.signal)]);
}

/// Whether a signal is off its floor, but for tags that only show how wrong the carriage's model is.
bool is_off(const Pattern& pattern, const SignalGap& gap) {
    return pattern.floors[index_of(gap.signal)] >= least_floors &&
           !(gap.signal == Signal::tag && tags_are_innocent(pattern));
}

bool does_matter(const SignalGap& gap, const SignalLimits& matters) {
    const double limit = matters[index_of(gap.signal)];
    return limit <= 0.0 || gap.discrepancy > limit;
}

Remainder remainder_of_signal(const SignalGap& gap, const Pattern& pattern, const Dependences& found) {
    const Signal signal = gap.signal;
    const auto first =
        found.groups.empty() ? std::nullopt : std::optional(static_cast<Dependence>(found.groups.front()));
    Remainder remainder{.block = std::string(accused_block(pattern, signal, first)),
                        .depends_on = {},
                        .text = {},
                        .signal = signal};
    for (const int group : found.groups) {
        const auto dependence = static_cast<Dependence>(group);
        std::string name(name_of(dependence));
        if (dependence == Dependence::position_period || dependence == Dependence::reading_period)
            name += fmt::format(" ({:.3g} mm)", found.period_mm);
        if (std::ranges::find(remainder.depends_on, name) == remainder.depends_on.end())
            remainder.depends_on.push_back(std::move(name));
    }
    remainder.text = what_remains(gap, pattern) +
                     (remainder.depends_on.empty()
                          ? std::string("nothing was found that they depend on")
                          : fmt::format("they depend on {}", fmt::join(remainder.depends_on, ", ")));
    return remainder;
}

}  // namespace

LeftOver::LeftOver(const Evidence& evidence, const CrossFit& explained)
    : evidence_(evidence),
      half_(halves(evidence)),
      errors_(held_out_errors(evidence, explained, half_)),
      gaps_(signal_gaps(evidence, explained.mean_squares, explained.mean_squares)),
      pattern_(pattern_of(evidence, gaps_, errors_)) {
    const std::optional<Signal> suspect = false_sensor(pattern_);
    std::ranges::sort(gaps_, std::greater{}, [&](const SignalGap& gap) {
        return std::pair(gap.signal == suspect, pattern_.floors[index_of(gap.signal)]);
    });
}

std::optional<Remainder> LeftOver::remainder_of(const SignalGap& gap, double tail,
                                                const SignalLimits& matters) const {
    if (!is_off(pattern_, gap) || !does_matter(gap, matters)) return {};
    // Where a gap is beyond doubt, what it likely depends on says more than nothing.
    const bool is_clear = pattern_.floors[index_of(gap.signal)] >= clear_floors;
    const std::array tails{tail, likely * tail};
    const Dependences found =
        dependences(evidence_, gap.signal, errors_, half_, std::span(tails).first(is_clear ? 2 : 1));
    if (found.groups.empty() && !is_clear) return {};
    return remainder_of_signal(gap, pattern_, found);
}

std::vector<Remainder> LeftOver::remainders(double tail, const SignalLimits& matters) const {
    std::vector<Remainder> all;
    for (const SignalGap& gap : gaps_)
        if (auto remainder = remainder_of(gap, tail, matters)) all.push_back(*std::move(remainder));
    return all;
}

std::optional<Remainder> LeftOver::first_remainder(double tail, const SignalLimits& matters) const {
    for (const SignalGap& gap : gaps_)
        if (auto remainder = remainder_of(gap, tail, matters)) return remainder;
    return {};
}

SignalFlags LeftOver::signals() const {
    SignalFlags left{};
    for (const SignalGap& gap : gaps_) left[index_of(gap.signal)] = is_off(pattern_, gap);
    return left;
}

std::optional<Remainder> remainder_of(const Evidence& evidence, const CrossFit& explained, double tail,
                                      const SignalLimits& matters) {
    return LeftOver(evidence, explained).first_remainder(tail, matters);
}

std::optional<Remainder> remainder_at_sight(std::span<const SignalGap> gaps, const SignalLimits& matters) {
    Pattern pattern;
    const SignalGap* furthest = nullptr;
    for (const SignalGap& gap : gaps) {
        double& floors = pattern.floors[index_of(gap.signal)];
        floors = gap.after / gap.floor;
        const bool is_further = furthest == nullptr || floors > pattern.floors[index_of(furthest->signal)];
        if (is_left(gap) && does_matter(gap, matters) && is_further) furthest = &gap;
    }
    if (furthest == nullptr) return {};
    const std::string what = what_remains(*furthest, pattern);
    return Remainder{.block = std::string(accused_block(pattern, furthest->signal, {})),
                     .depends_on = {},
                     .text = what + "there was no time to look for what they depend on",
                     .signal = furthest->signal};
}

}  // namespace fidservo::gap
