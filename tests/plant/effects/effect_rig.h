// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "plant/effects/catalogue.h"
#include "tests/plant/reference_rig.h"

#include <limits>
#include <span>
#include <string_view>

namespace fidservo::plant {

/// The reference rig with one effect, given as for the option --effect.
inline StagePlant plant_with(std::string_view effect) {
    const EffectSetting setting = parse_effect(effect);
    return make_stage_plant(reference_rig(), {&setting, 1});
}

/// The carriage with effects, on an infinite rail, so that nothing else acts. Without dead zone the command
/// is the effective voltage.
inline MacroAxis endless_axis_with(std::span<const EffectSetting> effects, bool dead_zone = false) {
    PlantParameters plant = plant_parameters(macro_only_rig());
    if (!dead_zone) plant.axis.dead_zone = {};
    apply_effects(plant, effects);
    plant.axis.low_mm = -std::numeric_limits<double>::infinity();
    plant.axis.high_mm = std::numeric_limits<double>::infinity();
    return make_macro_axis(plant.axis, plant.tick_s);
}

inline MacroAxis endless_axis_with(std::string_view effect, bool dead_zone = false) {
    const EffectSetting setting = parse_effect(effect);
    return endless_axis_with({&setting, 1}, dead_zone);
}

inline MacroAxisState after(const MacroAxis& axis, MacroAxisState state, double command_V, int ticks) {
    for (int k = 0; k < ticks; ++k) advance(axis, state, command_V);
    return state;
}

}  // namespace fidservo::plant
