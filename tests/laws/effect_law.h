// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The laws of the catalogue's effects as the independent model of the rig states them (reference/). A line
// for each effect, in effect_law.cpp, is all that its tests need.
#include "plant/effects/effect.h"
#include "reference/departures.h"

#include <iosfwd>
#include <span>
#include <string_view>

namespace fidservo {
struct Rig;
}

namespace fidservo::plant {
/// For GoogleTest: an effect by its name.
void PrintTo(const Effect* effect, std::ostream* out);
}  // namespace fidservo::plant

namespace fidservo::testing {

/// An effect with values, and what the independent model has to depart by to have the same.
struct EffectLaw {
    /// As parse_effect() takes it.
    std::string_view setting;
    /// Puts the same law, with the same values, into the departures of a rig.
    void (*depart)(reference::Departures& departures, const Rig& rig);
    /// Values at which the effect is nearly its simpler form; empty for an effect that has none.
    std::string_view nearly_plainer = {};
};

/// One for each effect of the catalogue, in no particular order.
std::span<const EffectLaw> effect_laws();

/// The reference rig with an effect.
plant::PlantParameters with(const plant::EffectSetting& setting);

/// The law of an effect; nullptr if there is none.
const EffectLaw* law_of(const plant::Effect& effect);

}  // namespace fidservo::testing
