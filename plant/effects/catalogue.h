// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The catalogue of effects, by name, and how they are put into a plant.
#include "plant/effects/effect.h"

#include <span>
#include <string>
#include <string_view>

namespace fidservo {
struct StatedEffect;
}

namespace fidservo::plant {

/// All effects, in the order in which a signal passes through the parts of the rig.
std::span<const Effect* const> effect_catalogue();

/// The effect with a name, or nullptr.
const Effect* find_effect(std::string_view name);

/// The effect with a name, in the catalogue or among others, or nullptr.
const Effect* find_effect(std::string_view name, std::span<const Effect* const> others);

/// Reads "NAME" or "NAME:PARAMETER=VALUE,...", as the option --effect takes it. Parameters that are not given
/// have their typical values. Throws InputError on an unknown effect or parameter, a parameter given twice,
/// and a value that is no number or out of bounds.
/// @param others  effects that are known beside those of the catalogue
EffectSetting parse_effect(std::string_view text, std::span<const Effect* const> others = {});

/// The setting that a rig file states. Parameters that are not given have their typical values. Throws
/// InputError like parse_effect.
EffectSetting setting_of(const StatedEffect& stated);

/// A setting as a rig file states it, with its formula if it is one.
StatedEffect stated(const EffectSetting& setting);

/// All parameters at their typical values.
EffectSetting typical_setting(const Effect& effect);

/// A setting that changes nothing.
EffectSetting vanishing_setting(const Effect& effect);

/// Puts effects into a plant's parameters. The order does not matter. Throws InputError if an effect is given
/// twice, or if the rig lacks the part that it acts on.
/// @param stated_at  as in StatedEffect; empty: they come from the option --effect
void apply_effects(PlantParameters& plant, std::span<const EffectSetting> effects,
                   const std::string& stated_at = {});

/// The plant of a rig, with effects that its file does not state.
StagePlant make_stage_plant(const Rig& rig, std::span<const EffectSetting> effects);

}  // namespace fidservo::plant
