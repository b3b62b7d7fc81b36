// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The catalogue's effects that the independent model (reference/) can simulate, and the ranges of their
// sizes.
#include "core/random.h"
#include "reference/departures.h"

#include <span>
#include <string_view>
#include <vector>

namespace fidservo::selfcheck {

/// A way to simulate an effect.
struct EffectDraw {
    /// Puts the effect with a size into the rig; its sign and shape are random.
    using Put = void (*)(reference::Departures& rig, double size, NoiseStream& draw);

    std::string_view effect;   ///< the catalogue's name
    std::string_view formula;  ///< which formula simulates it; empty: the catalogue's
    /// The size at which it causes an error of one floor (r.m.s.) in some signal of the reference rig's
    /// campaign, as measured.
    double floor_size;
    double largest;  ///< largest size; beyond it a rig would count as broken
    Put put;
};

/// In the order of the catalogue.
std::span<const EffectDraw> listed_effects();

/// The classes of the listed effects, each once. Effects of one class cannot be distinguished by any data.
const std::vector<std::string_view>& listed_classes();

/// All ways to simulate an effect of a class.
std::vector<const EffectDraw*> draws_of(std::string_view class_name);

/// Those of some ways that simulate an effect of a class.
std::vector<const EffectDraw*> draws_of(std::string_view class_name, std::span<const EffectDraw> ways);

/// Whether two classes may be drawn together; not if the parameters of one are part of the other's.
bool can_be_together(std::string_view class_name, std::string_view other);

/// Log-uniform between two positive limits.
double log_uniform(NoiseStream& draw, double low, double high);

/// +1 or -1.
double random_sign(NoiseStream& draw);

/// 1 + size or its inverse, at random.
double random_factor(NoiseStream& draw, double size);

}  // namespace fidservo::selfcheck
