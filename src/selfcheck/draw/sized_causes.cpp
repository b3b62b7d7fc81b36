// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/sized_causes.h"

#include "src/selfcheck/draw/other_formulas.h"
#include "src/selfcheck/draw/put_effect.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

/// Most effects show in one of the five signals, whose floors count by a fifth in squares.
constexpr double root_of_signals = 2.2;

}  // namespace

SizedCauses::SizedCauses(const Rig& nominal, Case& drawn, NoiseStream& draw)
    : nominal_(nominal), drawn_(drawn), draw_(draw), other_is_next_(random_sign(draw) > 0.0) {}

void SizedCauses::add_effect(const std::vector<std::string_view>& order, const GapAim& aim) {
    for (const std::string_view name : order) {
        if (!can_join(name, classes_)) continue;
        const auto [effect, is_other] = draw_way(name);
        const EffectDraw& way = *effect;
        NoiseStream shape(draw_.bits(), "self-check/shape");
        const auto put = [&](reference::Departures& rig, double size) {
            NoiseStream same = shape;
            way.put(rig, size, same);
        };
        const auto found = size_of(put, {root_of_signals * aim.target * way.floor_size, way.largest}, aim);
        if (!found) continue;
        put(drawn_.true_rig.departures, found->size);
        TrueEffect truth = true_effect(way, found->size);
        truth.gap_floors = found->gap_floors;
        drawn_.label.effects.push_back(std::move(truth));
        classes_.push_back(name);
        other_is_next_ = !is_other;
        return;
    }
    throw std::runtime_error(fmt::format("no effect makes a gap of {:.3g} floors alone", aim.target));
}

void SizedCauses::add_discrepancy(const std::vector<DiscrepancyKind>& order, const GapAim& aim) {
    for (const DiscrepancyKind& kind : order) {
        const NoiseStream shape(draw_.bits(), "self-check/discrepancy");
        const auto put = [&](reference::Departures& rig, double size) {
            NoiseStream same = shape;
            rig.discrepancy = draw_discrepancy(kind, nominal_, size, same);
        };
        const auto found = size_of(put, {kind.start_size, kind.largest}, aim);
        if (!found) continue;
        put(drawn_.true_rig.departures, found->size);
        drawn_.label.discrepancy = TrueDiscrepancy{std::string(kind.block), std::string(kind.depends_on),
                                                   found->size, found->gap_floors};
        return;
    }
    throw std::runtime_error(fmt::format("no discrepancy makes a gap of {:.3g} floors", aim.target));
}

SizedCauses::Way SizedCauses::draw_way(std::string_view name) {
    std::vector<const EffectDraw*> ways = other_formulas_of(name);
    const bool is_other = other_is_next_ && !ways.empty();
    if (!is_other) ways = draws_of(name);
    return {ways[index_below(draw_, ways.size())], is_other};
}

template <class Put>
std::optional<SizedGap> SizedCauses::size_of(const Put& put, const SizeRange& sizes,
                                             const GapAim& aim) const {
    return size_for_gap(
        [&](double size) {
            TrueRig alone{nominal_, {}};
            put(alone.departures, size);
            return gap_alone(nominal_, alone, drawn_.campaign_seed);
        },
        sizes, aim);
}

GapAim aim_between(double low, double high, NoiseStream& draw) {
    return {low, high, log_uniform(draw, low, high)};
}

bool can_join(std::string_view class_name, std::span<const std::string_view> others) {
    return std::ranges::all_of(others,
                               [&](std::string_view other) { return can_be_together(class_name, other); });
}

}  // namespace fidservo::selfcheck
