// SPDX-License-Identifier: GPL-3.0-or-later
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
#include "plant/effects/part.h"
#include "plant/stage_plant.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace fidservo::plant {

/// What a parameter says of its effect.
enum class Role {
    size,      ///< how much of it there is: without it at the vanishing value
    shape,     ///< what it is like
    optional,  ///< of what it may be without
    choice,    ///< which of two ways
    place,     ///< where on the rail
    width,     ///< over how much of the rail
    period,    ///< of a wave along the rail
    phase,     ///< of that wave at the left end of the rail
};

/// A number of an effect.
struct EffectParameter {
    std::string_view name;     ///< with its unit, e.g. "shift_degC"
    std::string_view unit;     ///< empty for a pure number
    double low;                ///< physical bounds, both included
    double high;               ///< the largest value that is tried
    double vanishing;          ///< without effect, exactly; of what only shapes the effect, the typical value
    double typical;            ///< where none is given
    std::string_view meaning;  ///< in words
    Role role = Role::size;    ///< what it is to a search
    /// From which a search may begin; empty: from the typical value, or anywhere on the rail.
    std::span<const double> starts = {};
    /// Of an optional one: values this near to the vanishing one count as that.
    double negligible = 0.0;

    /// Whether it is a size.
    bool is_size() const { return role == Role::size; }
    /// Whether it is one of a few choices.
    bool is_choice() const { return role == Role::choice; }
    /// Whether a value is nearer to the upper bound.
    bool is_high(double value) const { return value - low > high - value; }
    /// Whether it is a choice of what is not the vanishing value.
    bool is_unusual(double value) const { return is_choice() && is_high(value) != is_high(vanishing); }
    /// Whether a value is as good as the one without effect.
    bool is_negligible(double value) const { return std::abs(value - vanishing) < negligible; }
    /// The value that acts.
    double acting(double value) const { return is_negligible(value) ? vanishing : value; }
    /// Of a size: the typical one or, of what is typically absent, a quarter of the largest.
    double usual() const { return typical != vanishing ? typical : vanishing + 0.25 * (high - vanishing); }
};

namespace parameter {

/// Parameters as an effect's file lists them; what is in no such form is a size.
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
/// @param negligible  see EffectParameter
constexpr EffectParameter optional(EffectParameter of, double negligible,
                                   std::span<const double> starts = {}) {
    of.negligible = negligible;
    return with_role(of, Role::optional, starts);
}
/// Between 0 and 1.
/// @param usual  of the two, which is the vanishing and typical value
constexpr EffectParameter choice(std::string_view name, double usual, std::string_view meaning) {
    return {name, "", 0.0, 1.0, usual, usual, meaning, Role::choice};
}

}  // namespace parameter

struct Effect;
class FormulaCode;

/// The plainer effect that an effect comes to where what sets it apart vanishes.
struct PlainerForm {
    const Effect* effect = nullptr;  ///< none: it comes to none
    /// Its size that does roughly the same; nullptr: the richer one's first parameter.
    /// @param middle_mm  of the rail
    double (*size)(std::span<const double> richer, double middle_mm) = nullptr;
};

/// An effect of the catalogue: all that there is to know of it.
struct Effect {
    std::string_view name;                        ///< by which files and options call it
    std::string_view block;                       ///< e.g. "macro.drive"
    Part part;                                    ///< which part of the rig it changes
    std::string_view text;                        ///< what it is, for people, with its equation
    std::string_view source;                      ///< where its equation is from
    std::span<const EffectParameter> parameters;  ///< its numbers, in the order of values
    /// One value per parameter, within bounds; the part exists. Of a formula: nullptr.
    void (*apply)(PlantParameters& plant, std::span<const double> values) = nullptr;
    /// Whether it acts at a place on the rail that its parameters state, so that only who knows where the
    /// carriage is can find it. What repeats along the rail does not: its phase counts from anywhere.
    bool needs_place = false;
    PlainerForm plainer = {};  ///< the plainer effect that it contains
    /// Another effect that no recording can tell it from.
    const Effect* same_as = nullptr;
    /// What acts in place of apply (plant/formulas/formula_effect.h); nullptr of listed ones.
    const FormulaCode* formula = nullptr;

    /// The first of its parameters that has a role; none where it has no such parameter.
    std::optional<std::size_t> place_of(Role role) const {
        for (std::size_t k = 0; k < parameters.size(); ++k)
            if (parameters[k].role == role) return k;
        return {};
    }
};

/// Puts an effect into a plant's parameters. One value per parameter, within bounds; the part exists.
void put(const Effect& effect, PlantParameters& plant, std::span<const double> values);

/// An effect with the values of its parameters, in its order.
struct EffectSetting {
    const Effect* effect;        ///< which
    std::vector<double> values;  ///< of its parameters, in their order

    bool operator==(const EffectSetting&) const = default;
};

}  // namespace fidservo::plant
