// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/crowded_draw.h"

#include "plant/effects/catalogue.h"
#include "src/selfcheck/draw/put_effect.h"
#include "src/selfcheck/draw/sized_causes.h"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

using enum CaseKind;
constexpr std::array crowded_kinds{three, messy, messy_none};
constexpr KindCycle crowded_cycle(crowded_kinds, "crowded/row");

using Names = std::vector<std::string_view>;

/// Whether no effect of the one class is of a block that an effect of the other one is of.
bool are_of_other_blocks(std::string_view class_name, std::string_view other) {
    for (const EffectDraw* a : draws_of(class_name))
        for (const EffectDraw* b : draws_of(other))
            if (plant::find_effect(a->effect)->block == plant::find_effect(b->effect)->block) return false;
    return true;
}

void put_three(Case& drawn, std::string_view first, NoiseStream& draw) {
    Names names{first};
    while (names.size() < 3) {
        Names further;
        for (const std::string_view name : listed_classes())
            if (can_join(name, names) && std::ranges::all_of(names, [&](std::string_view other) {
                    return are_of_other_blocks(name, other);
                }))
                further.push_back(name);
        names.push_back(further[index_below(draw, further.size())]);
    }
    for (const std::string_view name : names)
        drawn.label.effects.push_back(put_listed(drawn.true_rig, name, draw));
}

void put_messy(const Rig& nominal, Case& drawn, std::uint64_t seed, std::size_t k, NoiseStream& draw) {
    SizedCauses causes(nominal, drawn, draw);
    double largest_small = small_floors[1];
    if (drawn.label.kind == messy) {
        Names order = shuffled(std::span(listed_classes()), draw);
        order.insert(order.begin(), met(std::span(listed_classes()), seed, messy, k));
        causes.add_effect(order, aim_between(dominant_floors[0], dominant_floors[1], draw));
        largest_small = std::min(largest_small, drawn.label.effects.front().gap_floors / dominance);
    }
    for (std::size_t i = 0; i < small_effects; ++i)
        causes.add_effect(shuffled(std::span(listed_classes()), draw),
                          aim_between(small_floors[0], largest_small, draw));
    std::vector<DiscrepancyKind> order = shuffled(discrepancy_kinds(), draw);
    order.insert(order.begin(), met(discrepancy_kinds(), seed, drawn.label.kind, k));
    causes.add_discrepancy(order, aim_between(discrepancy_floors[0], discrepancy_floors[1], draw));
}

}  // namespace

bool is_crowded(CaseKind kind) {
    return crowded_cycle.has(kind);
}

CaseKind kind_of_crowded_case(std::uint64_t seed, std::size_t number) {
    return crowded_cycle.kind_of(seed, number);
}

Case draw_crowded_case(const Rig& nominal, std::uint64_t seed, std::size_t number) {
    NoiseStream draw(seed, fmt::format("self-check/crowded/case/{}", number));
    Case drawn{.number = number,
               .label = {kind_of_crowded_case(seed, number), {}, {}},
               .true_rig = {nominal, {}},
               .without = {},
               .campaign_seed = draw.bits()};
    const std::size_t k = crowded_cycle.ordinal_of(seed, number);
    if (drawn.label.kind == three)
        put_three(drawn, met(std::span(listed_classes()), seed, three, k), draw);
    else
        put_messy(nominal, drawn, seed, k, draw);
    return drawn;
}

}  // namespace fidservo::selfcheck
