// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/crowded_draw.h"

#include "gap/candidates/candidate.h"
#include "plant/effects/catalogue.h"
#include "src/selfcheck/draw/discrepancy_draw.h"
#include "src/selfcheck/draw/gap_alone.h"
#include "src/selfcheck/draw/other_formulas.h"
#include "src/selfcheck/draw/put_effect.h"
#include "src/selfcheck/draw/rounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

using enum CaseKind;
constexpr std::array crowded_kinds{three, messy, messy_none};
constexpr KindCycle crowded_cycle(crowded_kinds, "crowded/row");

using Names = std::vector<std::string_view>;

bool fits(std::string_view class_name, const Names& others) {
    return std::ranges::all_of(others,
                               [&](std::string_view other) { return can_be_together(class_name, other); });
}

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
            if (fits(name, names) && std::ranges::all_of(names, [&](std::string_view other) {
                    return are_of_other_blocks(name, other);
                }))
                further.push_back(name);
        names.push_back(further[index_below(draw, further.size())]);
    }
    for (const std::string_view name : names)
        drawn.label.effects.push_back(put_listed(drawn.true_rig, name, draw));
}

/// Puts causes into a messy rig one by one.
class MessyRig {
  public:
    /// @param draw  of the case
    MessyRig(const Rig& nominal, Case& drawn, NoiseStream& draw)
        : nominal_(nominal), drawn_(drawn), draw_(draw), other_is_next_(random_sign(draw) > 0.0) {}

    /// Of the classes in their order, the first one that goes with those before it and that comes to the aim.
    void add_effect(const Names& order, const GapAim& aim) {
        for (const std::string_view name : order) {
            if (!fits(name, classes_)) continue;
            const auto [drawn_way, is_other] = draw_way(name);
            const EffectDraw& way = *drawn_way;
            NoiseStream shape(draw_.bits(), "self-check/shape");
            const auto put = [&](reference::Departures& rig, double size) {
                NoiseStream same = shape;
                way.put(rig, size, same);
            };
            const auto found = size_of(put, {signals * aim.target * way.floor_size, way.largest}, aim);
            if (!found) continue;
            put(drawn_.true_rig.departures, found->size);
            TrueEffect effect = true_effect(way, found->size);
            effect.gap_floors = found->gap_floors;
            drawn_.label.effects.push_back(std::move(effect));
            classes_.push_back(name);
            other_is_next_ = !is_other;
            return;
        }
        throw std::runtime_error(fmt::format("no effect makes a gap of {:.3g} floors alone", aim.target));
    }

    /// Of the kinds in their order, the first one that comes to the aim.
    void add_discrepancy(const std::vector<DiscrepancyKind>& order, const GapAim& aim) {
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

  private:
    /// Most effects show in one of the five signals, whose floors count by a fifth in squares.
    static constexpr double signals = 2.2;

    struct Drawn {
        const EffectDraw* way;
        bool is_other;  ///< by another formula than the catalogue's
    };

    Drawn draw_way(std::string_view name) {
        std::vector<const EffectDraw*> ways = other_formulas_of(name);
        const bool is_other = other_is_next_ && !ways.empty();
        if (!is_other) ways = draws_of(name);
        return {ways[index_below(draw_, ways.size())], is_other};
    }

    template <class Put>
    std::optional<SizedGap> size_of(const Put& put, const SizeRange& sizes, const GapAim& aim) const {
        return size_for_gap(
            [&](double size) {
                TrueRig alone{nominal_, {}};
                put(alone.departures, size);
                return gap_alone(nominal_, alone, drawn_.campaign_seed);
            },
            sizes, aim);
    }

    const Rig& nominal_;
    Case& drawn_;
    NoiseStream& draw_;
    bool other_is_next_;
    Names classes_;
};

GapAim aim_between(double low, double high, NoiseStream& draw) {
    return {low, high, log_uniform(draw, low, high)};
}

template <class Item>
std::vector<Item> shuffled(std::span<const Item> items, NoiseStream& draw) {
    std::vector<Item> order(items.begin(), items.end());
    shuffle(order, NoiseStream(draw.bits(), "self-check/order"));
    return order;
}

void put_messy(const Rig& nominal, Case& drawn, std::uint64_t seed, std::size_t k, NoiseStream& draw) {
    MessyRig rig(nominal, drawn, draw);
    double largest_small = small_floors[1];
    if (drawn.label.kind == messy) {
        Names order = shuffled(std::span(listed_classes()), draw);
        order.insert(order.begin(), met(std::span(listed_classes()), seed, messy, k));
        rig.add_effect(order, aim_between(dominant_floors[0], dominant_floors[1], draw));
        largest_small = std::min(largest_small, drawn.label.effects.front().gap_floors / dominance);
    }
    for (std::size_t i = 0; i < small_effects; ++i)
        rig.add_effect(shuffled(std::span(listed_classes()), draw),
                       aim_between(small_floors[0], largest_small, draw));
    std::vector<DiscrepancyKind> order = shuffled(discrepancy_kinds(), draw);
    order.insert(order.begin(), met(discrepancy_kinds(), seed, drawn.label.kind, k));
    rig.add_discrepancy(order, aim_between(discrepancy_floors[0], discrepancy_floors[1], draw));
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
