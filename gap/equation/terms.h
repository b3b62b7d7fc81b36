// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an equation for a remainder may be made of: the terms that a port's formulas can have.
//
// A term is a function of what its port knows (plant/formulas/port.h), with a coefficient of its own. Most
// are powers, products and signs; some have shapes, a period, a scale, a centre, of which the library holds
// several values that are refined later; some lag behind what they know, by a time that is such a shape.
// Powers are continued by their end values outside of what the recordings have covered: what is known of them
// ends there.
#include "core/formula_effect.h"
#include "gap/evidence.h"
#include "plant/formulas/port.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::gap {

/// What recordings have covered of a variable.
struct Covered {
    double low = 0.0, high = 0.0;

    double middle() const { return 0.5 * (low + high); }
    double half() const { return 0.5 * (high - low); }
};

/// Of all recordings, by the rig file's model where nothing measures it.
struct CoveredRanges {
    Covered time_s, command_V, place_mm, speed_mm_per_s, way_mm, wire_degC, contraction_mm;
    Covered power_degC = {};            ///< of the heater
    Covered heater_V = {};              ///< its command
    Covered tag_mm = {}, view_mm = {};  ///< tags' places along the rail, and the camera's
};

CoveredRanges covered_ranges(const Evidence& evidence);

/// A period, a scale, a place or a time in a term.
struct TermShape {
    std::string unit;
    double value, low, high;
};

/// How shapes and what remembers are called in a term's expressions.
inline constexpr std::array<std::string_view, 2> shape_names{"shape", "centre"};
inline constexpr std::string_view memory_name = "kept";

struct Term {
    /// One expression for each coefficient: sine and cosine have two.
    std::vector<std::string> texts;
    std::string unit;  ///< of the expressions' values; empty for a pure number
    double size;       ///< about how large these are
    std::vector<TermShape> shapes;
    int family;         ///< terms that differ by their shapes alone share it
    std::string words;  ///< what a coefficient of it says, e.g. "growing with the square of speed"
    std::optional<FormulaEffect::Memory> memory = {};
};

/// @param periods_mm  on the rail, of which waves may be
std::vector<Term> terms_of(plant::Port port, const CoveredRanges& ranges, std::span<const double> periods_mm);

}  // namespace fidservo::gap
