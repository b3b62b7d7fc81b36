// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/rough_draw.h"

#include "gap/residuals/accusation.h"
#include "plant/effects/catalogue.h"
#include "src/selfcheck/draw/sized_causes.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::selfcheck {
namespace {

gap::Stage stage_of_class(std::string_view class_name) {
    return gap::stage_of(plant::find_effect(draws_of(class_name).front()->effect)->block);
}

/// Of one stage.
struct Causes {
    std::vector<std::string_view> classes;
    std::vector<DiscrepancyKind> discrepancies;
};

Causes causes_beside(std::string_view class_name, NoiseStream& draw) {
    const gap::Stage stage = stage_of_class(class_name);
    Causes causes{shuffled(std::span(listed_classes()), draw), shuffled(discrepancy_kinds(), draw)};
    std::erase_if(causes.classes, [&](std::string_view name) { return stage_of_class(name) != stage; });
    std::erase_if(causes.discrepancies,
                  [&](const DiscrepancyKind& kind) { return gap::stage_of(kind.block) != stage; });
    return causes;
}

}  // namespace

CaseKind kind_of_rough_case(std::uint64_t /*seed*/, std::size_t /*number*/) {
    return CaseKind::rough;
}

Case draw_rough_case(const Rig& nominal, std::uint64_t seed, std::size_t number) {
    NoiseStream draw(seed, fmt::format("self-check/rough/case/{}", number));
    Case drawn{.number = number,
               .label = {CaseKind::rough, {}, {}},
               .true_rig = {nominal, {}},
               .without = {},
               .campaign_seed = draw.bits()};
    const std::string_view first = met(std::span(listed_classes()), seed, CaseKind::rough, number);
    auto [classes, discrepancies] = causes_beside(first, draw);
    std::erase(classes, first);
    classes.insert(classes.begin(), first);
    SizedCauses causes(nominal, drawn, draw);
    causes.add_effect(classes, aim_between(rough_floors[0], rough_floors[1], draw));
    const double larger = drawn.label.effects.front().gap_floors;
    causes.add_effect(shuffled(std::span<const std::string_view>(classes), draw),
                      aim_between(rough_second[0] * larger, rough_second[1] * larger, draw));
    causes.add_discrepancy(discrepancies,
                           aim_between(rough_discrepancy[0] * larger, rough_discrepancy[1] * larger, draw));
    return drawn;
}

}  // namespace fidservo::selfcheck
