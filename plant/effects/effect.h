#pragma once
// An unmodelled effect: something that a real rig has and its file does not state, as a change of the plant.
//
// An effect is a value, in one file of this folder: its name, the block it belongs to, its parameters, and a
// function that puts it into the plant's parameters before the plant is made. A tick does not know of
// effects; it evaluates the parts' parameters, each of which has a neutral value (a factor of 1, an offset of
// 0). An effect at its vanishing values leaves every parameter as it was, bit for bit, so that the simulated
// run is the same, byte for byte.
//
// Where an effect acts follows from the equations of the part that it changes:
//   - drive, forces that a carriage at rest feels too: before the dead zone (plant/macro_axis.h: g, b);
//   - friction and inertia of the moving carriage: K and tau of the axis;
//   - sensors: their curves; heater and wire: their parameters; camera: its timing.
#include "plant/stage_plant.h"

#include <cmath>
#include <span>
#include <string_view>
#include <vector>

namespace fidservo::plant {

struct EffectParameter {
    std::string_view name;  ///< with its unit, e.g. "shift_degC"
    std::string_view unit;  ///< empty for a pure number
    double low;             ///< physical bounds, both included
    double high;
    double vanishing;  ///< without effect, exactly; of what only shapes the effect, the typical value
    double typical;    ///< where none is given
    std::string_view meaning;
    /// Of what an effect may be without: values this near to the vanishing one count as that, which is then
    /// also its typical one. 0: it has no such parameter.
    double negligible = 0.0;
    bool is_choice = false;  ///< only its bounds are meant: the nearer one

    bool is_high(double value) const { return value - low > high - value; }
    /// Whether it is a choice of what is not the vanishing value.
    bool is_unusual(double value) const { return is_choice && is_high(value) != is_high(vanishing); }
    bool is_negligible(double value) const { return std::abs(value - vanishing) < negligible; }
    /// The value that acts.
    double acting(double value) const { return is_negligible(value) ? vanishing : value; }
};

struct Effect {
    std::string_view name;
    std::string_view block;  ///< e.g. "macro.drive"
    std::string_view text;   ///< what it is, for people, with its equation
    std::string_view source;
    std::span<const EffectParameter> parameters;
    /// One value per parameter, within bounds; the part that the block names exists.
    void (*apply)(PlantParameters& plant, std::span<const double> values);
    /// Whether it acts at a place on the rail that its parameters state, so that only who knows where the
    /// carriage is can find it. What repeats along the rail does not: its phase counts from anywhere.
    bool needs_place = false;
};

/// An effect with the values of its parameters, in its order.
struct EffectSetting {
    const Effect* effect;
    std::vector<double> values;

    bool operator==(const EffectSetting&) const = default;
};

}  // namespace fidservo::plant
