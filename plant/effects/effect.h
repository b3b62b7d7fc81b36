// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An unmodelled effect: something that a real rig has and its file does not state, as a change of the plant's
// parameters.
//
// An effect is a value, in one file of this folder: its name, the block it belongs to, its parameters, and a
// function that puts it into the plant's parameters before the plant is made. The simulation of a tick knows
// no effects; it evaluates the parts' parameters, each of which has a neutral value (a factor of 1, an offset
// of 0). An effect at its vanishing values leaves every parameter as it was, bit for bit, so that the
// simulated run is the same, byte for byte.
//
// Where an effect acts follows from the equations of the part that it changes:
//   - drive, forces that a carriage at rest feels too: before the dead zone (plant/macro_axis.h: g, b);
//   - friction and inertia of the moving carriage: K and tau of the axis;
//   - sensors: their curves; heater and wire: their parameters; camera: its timing.
#include "plant/effects/part.h"
#include "plant/stage_plant.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::plant {

/// What a parameter describes of its effect.
enum class Role {
    size,      ///< how strong the effect is; at the vanishing value there is none
    shape,     ///< its form
    optional,  ///< a form that the effect may also be without
    choice,    ///< one of two alternatives
    place,     ///< where on the rail it acts
    width,     ///< over which length of the rail it acts
    period,    ///< period of a wave along the rail
    phase,     ///< phase of that wave at the left end of the rail
};

/// A number of an effect.
struct EffectParameter {
    std::string_view name;  ///< with its unit, e.g. "shift_degC"
    std::string_view unit;  ///< empty for a dimensionless number
    double low;             ///< the smallest value that is physically possible
    double high;            ///< the largest value that is tried
    /// The value without effect, exactly; of a parameter that only shapes the effect, the typical value.
    double vanishing;
    double typical;            ///< the value where none is given
    std::string_view meaning;  ///< in words
    Role role = Role::size;    ///< how a search treats it
    /// The values from which a search may begin; empty: from the typical value, or anywhere on the rail.
    std::span<const double> starts = {};
    /// Of an optional parameter: values within this distance of the vanishing one count as vanishing.
    double negligible = 0.0;

    /// Whether the parameter is a size.
    bool is_size() const { return role == Role::size; }
    /// Whether the parameter is one of two alternatives.
    bool is_choice() const { return role == Role::choice; }
    /// Whether a value is nearer to the upper bound than to the lower one.
    bool is_high(double value) const { return value - low > high - value; }
    /// Whether a value is the alternative that is not the default.
    bool is_unusual(double value) const { return is_choice() && is_high(value) != is_high(vanishing); }
    /// Whether a value counts as vanishing.
    bool is_negligible(double value) const { return std::abs(value - vanishing) < negligible; }
    /// The value with which the simulation computes: the vanishing one where the value is negligible.
    double acting(double value) const { return is_negligible(value) ? vanishing : value; }
    /// A usual value of a size: the typical one or, where that is the vanishing one, a quarter of the way to
    /// the largest.
    double usual() const { return typical != vanishing ? typical : vanishing + 0.25 * (high - vanishing); }
};

namespace parameter {

/// Gives a parameter a role. A parameter that an effect's file lists without one is a size.
constexpr EffectParameter with_role(EffectParameter of, Role role, std::span<const double> starts = {}) {
    of.role = role;
    of.starts = starts;
    return of;
}
/// A parameter as a size, with values from which a search may begin.
constexpr EffectParameter size(EffectParameter of, std::span<const double> starts) {
    return with_role(of, Role::size, starts);
}
/// A parameter as a shape, with values from which a search may begin.
constexpr EffectParameter shape(EffectParameter of, std::span<const double> starts = {}) {
    return with_role(of, Role::shape, starts);
}
/// A parameter as an optional one.
/// @param negligible  as in EffectParameter
constexpr EffectParameter optional(EffectParameter of, double negligible,
                                   std::span<const double> starts = {}) {
    of.negligible = negligible;
    return with_role(of, Role::optional, starts);
}
/// A parameter as one of two alternatives, 0 and 1.
/// @param usual  the alternative that is the vanishing and typical value
constexpr EffectParameter choice(std::string_view name, double usual, std::string_view meaning) {
    return {name, "", 0.0, 1.0, usual, usual, meaning, Role::choice};
}

}  // namespace parameter

struct Effect;
class FormulaCode;

/// The simpler effect that an effect becomes where its additional parameters vanish.
struct PlainerForm {
    const Effect* effect = nullptr;  ///< nullptr: there is no simpler effect
    /// The size of the simpler effect that does roughly the same; nullptr: the first parameter of the richer
    /// effect.
    /// @param middle_mm  middle of the rail
    double (*size)(std::span<const double> richer, double middle_mm) = nullptr;
};

/// What the sizes of an effect do that is put into a plant which has the effect already. Its other parameters
/// take the place of those before.
enum class Again {
    adds,          ///< sizes add up or, of factors, multiply
    adds_squares,  ///< sizes add up in quadrature
    replaces,      ///< sizes take the place of those before, too
};

/// An effect of the catalogue, with everything that is known of it.
struct Effect {
    std::string_view name;                        ///< by which files and options call it
    std::string_view block;                       ///< e.g. "macro.drive"
    Part part;                                    ///< which part of the rig it changes
    std::string_view text;                        ///< what it is, for people, with its equation
    std::string_view source;                      ///< where its equation is from
    std::span<const EffectParameter> parameters;  ///< in the order in which values are given
    /// Puts the effect into a plant that has the part. One value per parameter, within bounds. nullptr for a
    /// formula.
    void (*apply)(PlantParameters& plant, std::span<const double> values) = nullptr;
    /// Whether it acts at a place on the rail that its parameters state, so that a search needs the
    /// carriage's absolute position. What is periodic along the rail does not need it: its phase may be
    /// counted from anywhere.
    bool needs_place = false;
    PlainerForm plainer = {};   ///< the simpler effect that it contains
    Again again = Again::adds;  ///< what happens where the plant has it already
    /// Another effect from which no recording can distinguish it.
    const Effect* same_as = nullptr;
    /// The formula that acts in place of apply (plant/formulas/formula_effect.h); nullptr for effects of the
    /// catalogue.
    const FormulaCode* formula = nullptr;

    /// The index of the first parameter with a role; empty if there is none.
    std::optional<std::size_t> place_of(Role role) const {
        for (std::size_t k = 0; k < parameters.size(); ++k)
            if (parameters[k].role == role) return k;
        return {};
    }
};

/// Puts an effect into the parameters of a plant that has the part which it acts on. One value per parameter,
/// within bounds.
/// @param stated_at  as in StatedEffect
void put(const Effect& effect, PlantParameters& plant, std::span<const double> values,
         const std::string& stated_at = {});

/// An effect with the values of its parameters, in its order.
struct EffectSetting {
    const Effect* effect;        ///< the effect
    std::vector<double> values;  ///< of its parameters, in their order

    bool operator==(const EffectSetting&) const = default;
};

}  // namespace fidservo::plant
