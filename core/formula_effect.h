// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An effect that a user has written as a formula at a port of the machine, as the text of an effects file
// (docs/effects.md), not yet parsed. What its names mean and whether it can be evaluated is for
// plant/formulas to say.
#include <string>
#include <vector>

namespace fidservo {

/// An effect written as a formula; docs/effects.md explains the language.
struct FormulaEffect {
    /// A number in the formula, which a diagnosis may fit.
    struct Parameter {
        std::string name = {};  ///< as the formula calls it
        std::string unit = {};  ///< empty for a pure number
        double low = 0.0;       ///< the smallest value allowed
        double high = 0.0;      ///< the largest value allowed
        /// The value without effect; of a parameter that only shapes the effect, any value.
        double vanishing = 0.0;
        double typical = 0.0;       ///< the value where none is given
        std::string role = "size";  ///< "size", "shape" or "optional": docs/effects.md
        /// Of a shape: the values from which a fit may begin; empty: spread over the bounds.
        std::vector<double> starts = {};
        std::string text = {};  ///< what it is, for people

        bool operator==(const Parameter&) const = default;
    };

    /// A quantity with memory, which the formula refers to by its name.
    struct Memory {
        /// What is remembered.
        enum class Kind {
            state,  ///< `of` is the quantity's time derivative, per s
            play,   ///< a play operator of width `by`: follows `of` once that is half of `by` ahead
            delay,  ///< the value of `of`, `by` seconds ago
        };
        std::string name = {};    ///< as the formula calls it
        Kind kind = Kind::state;  ///< which law it follows
        std::string of = {};      ///< an expression: what the memory follows
        std::string by = {};      ///< an expression of parameters alone: width or delay; unused by states

        bool operator==(const Memory&) const = default;
    };

    std::string name = {};                   ///< as files and options call the effect
    std::string block = {};                  ///< e.g. "macro.friction"
    std::string acts_on = {};                ///< the port, e.g. "macro.friction"
    std::string formula = {};                ///< an expression: what is added at the port, in the port's unit
    std::vector<Parameter> parameters = {};  ///< its numbers
    std::vector<Memory> memories = {};       ///< the quantities with memory that the formula uses
    std::string text = {};                   ///< what it is, for people
    std::string source = {};                 ///< where the formula is from

    bool operator==(const FormulaEffect&) const = default;
};

}  // namespace fidservo
