// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/case_draw.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/selfcheck/draw/listed_effects.h"
#include "src/selfcheck/draw/put_effect.h"
#include "src/selfcheck/draw/rounds.h"
#include "src/selfcheck/draw/true_formula.h"
#include "src/selfcheck/draw/unlisted_effects.h"

#include <array>
#include <span>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

using enum CaseKind;
constexpr std::array kinds_in_turn{none, none, one, one, one, one, two, two, withheld, unlisted};
constexpr KindCycle cycle(kinds_in_turn, "cycle");

TrueEffect put_unlisted(Case& drawn, const UnlistedEffect& effect, NoiseStream& draw) {
    const double size = log_uniform(draw, effect.smallest, effect.largest);
    effect.put(drawn.true_rig, size, draw);
    return {.effect = std::string(effect.name),
            .class_name = std::string(effect.name),
            .block = std::string(effect.block),
            .formula = "",
            .size = size,
            .expected_floors = 0.0};
}

/// A class that can be together with another one; every other time, where there is one, of the same block.
std::string_view partner_of(std::string_view class_name, bool same_block, NoiseStream& draw) {
    const auto block_of = [](std::string_view name) { return plant::find_effect(name)->block; };
    std::vector<std::string_view> partners;
    for (const bool wanted : {same_block, !same_block}) {
        for (const std::string_view other : listed_classes())
            if (can_be_together(class_name, other) && (block_of(other) == block_of(class_name)) == wanted)
                partners.push_back(other);
        if (!partners.empty()) break;
    }
    return partners[index_below(draw, partners.size())];
}

}  // namespace

CaseKind kind_of_case(std::uint64_t seed, std::size_t number) {
    return cycle.kind_of(seed, number);
}

Case draw_case(const Rig& nominal, std::uint64_t seed, std::size_t number) {
    NoiseStream draw(seed, fmt::format("self-check/case/{}", number));
    Case drawn{.number = number,
               .label = {kind_of_case(seed, number), {}},
               .true_rig = {nominal, {}},
               .without = {},
               .campaign_seed = draw.bits()};
    const std::size_t k = cycle.ordinal_of(seed, number);
    const CaseKind kind = drawn.label.kind;
    std::vector<TrueEffect>& effects = drawn.label.effects;
    if (kind == unlisted) {
        effects.push_back(put_unlisted(drawn, met(unlisted_effects(), seed, kind, k), draw));
    } else if (kind != none) {
        const std::string_view first = met(std::span(listed_classes()), seed, kind, k);
        effects.push_back(put_listed(drawn.true_rig, first, draw));
        if (kind == two)
            effects.push_back(put_listed(drawn.true_rig, partner_of(first, k % 2 == 0, draw), draw));
        if (kind == withheld) drawn.without.push_back(effects.front().effect);
    }
    if (kind == unlisted || kind == withheld)
        effects.front().as_formula = as_formula(drawn.true_rig, nominal, effects.front().effect);
    return drawn;
}

}  // namespace fidservo::selfcheck
