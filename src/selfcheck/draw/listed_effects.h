// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The effects of the catalogue that the independent model of rigs (reference/) can have, and how large they
// are drawn.
#include "core/random.h"
#include "reference/departures.h"

#include <span>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// A way to make an effect.
struct EffectDraw {
    /// Puts the effect of a size into the rig; its sign and shape are drawn.
    using Put = void (*)(reference::Departures& rig, double size, NoiseStream& draw);

    std::string_view effect;   ///< the catalogue's name
    std::string_view formula;  ///< empty for the plain one
    /// The size at which the reference rig's campaign shows it by one floor (r.m.s.) in some signal.
    /// Measured.
    double floor_size;
    double largest;  ///< beyond it a rig would be called broken
    Put put;
};

/// In the order of the catalogue.
std::span<const EffectDraw> listed_effects();

/// The classes among them, each once.
const std::vector<std::string_view>& listed_classes();

/// Of a class.
std::vector<const EffectDraw*> draws_of(std::string_view class_name);

/// Those of a class among some ways.
std::vector<const EffectDraw*> draws_of(std::string_view class_name, std::span<const EffectDraw> ways);

/// Whether two classes may be drawn together: not where the one's parameters are part of the other's.
bool can_be_together(std::string_view class_name, std::string_view other);

/// Between two positive limits, evenly in the logarithm.
double log_uniform(NoiseStream& draw, double low, double high);

/// +1 or -1.
double random_sign(NoiseStream& draw);

/// 1 + size or its inverse.
double random_factor(NoiseStream& draw, double size);

}  // namespace fidservo::selfcheck
