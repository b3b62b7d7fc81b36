// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The terms from which an equation may be made at each port.
//
// A term is a function of the port's variables (plant/formulas/port.h) with a coefficient of its own. Most
// are powers, products and signs. Some have shapes (a period, a scale, a centre), of which the library has
// several values that are refined later; some lag behind a variable by a time that is such a shape. Outside
// of the range that the recordings cover, powers keep their value at the range's end, as nothing is known
// there.
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

/// The range of a variable that recordings cover.
struct Covered {
    double low = 0.0, high = 0.0;

    double middle() const { return 0.5 * (low + high); }
    double half() const { return 0.5 * (high - low); }
};

/// The ranges over all recordings; where a variable is not measured, by the rig file's model.
struct CoveredRanges {
    Covered time_s, command_V, place_mm, speed_mm_per_s, way_mm, wire_degC, contraction_mm;
    Covered power_degC = {};            ///< the heater's power
    Covered heater_V = {};              ///< the heater's command
    Covered tag_mm = {}, view_mm = {};  ///< positions of tags along the rail, and of the camera
};

CoveredRanges covered_ranges(const Evidence& evidence);

/// A parameter of a term besides its coefficient: a period, a scale, a place or a time.
struct TermShape {
    std::string unit;
    double value, low, high;
};

/// Names of shapes and of the memory in a term's expressions.
inline constexpr std::array<std::string_view, 2> shape_names{"shape", "centre"};
inline constexpr std::string_view memory_name = "kept";

struct Term {
    /// One expression for each coefficient; a wave has two, sine and cosine.
    std::vector<std::string> texts;
    std::string unit;  ///< unit of the expressions' values; empty for a dimensionless number
    double size;       ///< order of magnitude of those values
    std::vector<TermShape> shapes;
    int family;         ///< shared by terms that differ only in their shapes
    std::string words;  ///< describes the term, e.g. "growing with the square of speed"
    std::optional<FormulaEffect::Memory> memory = {};
};

/// @param periods_mm  possible periods along the rail
std::vector<Term> terms_of(plant::Port port, const CoveredRanges& ranges, std::span<const double> periods_mm);

}  // namespace fidservo::gap
