#pragma once
// What an equation for a remainder may be made of: the terms that a port's formulas can have.
//
// A term is a function of what its port knows (plant/formulas/port.h), with a coefficient of its own. Most
// are powers, products and signs; some have a shape, a period or a scale, of which the library holds several
// values that are refined later. Powers are continued by their end values outside of what the recordings have
// covered: what is known of them ends there.
#include "gap/evidence.h"
#include "plant/formulas/port.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fidservo::gap {

/// What recordings have covered of a variable: between the 1st and the 99th percent of its values.
struct Covered {
    double low = 0.0, high = 0.0;

    double middle() const { return 0.5 * (low + high); }
    double half() const { return 0.5 * (high - low); }
};

/// Of all recordings, by the rig file's model where nothing measures it.
struct CoveredRanges {
    Covered time_s, command_V, place_mm, speed_mm_per_s, way_mm, wire_degC, contraction_mm;
};

CoveredRanges covered_ranges(const Evidence& evidence);

/// A period or a scale in a term.
struct TermShape {
    std::string name, unit;
    double value, low, high;
};

struct Term {
    /// One expression for each coefficient: sine and cosine have two. `shape` is the shape's name in them.
    std::vector<std::string> texts;
    std::string unit;  ///< of the expressions' values; empty for a pure number
    double size;       ///< about how large these are
    std::optional<TermShape> shape;
    int family;         ///< terms that differ by their shape alone share it
    std::string words;  ///< what a coefficient of it says, e.g. "growing with the square of speed"
};

/// @param periods_mm  on the rail, of which waves may be
std::vector<Term> terms_of(plant::Port port, const CoveredRanges& ranges, std::span<const double> periods_mm);

}  // namespace fidservo::gap
