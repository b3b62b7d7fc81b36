// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An effect that somebody has written down as a formula at a port of the machine: the text of an effects file
// (docs/effects.md), not yet looked at. What its names mean and whether it can be evaluated is for
// plant/formulas to say.
#include <string>
#include <vector>

namespace fidservo {

/// An effect written as a formula; docs/effects.md explains the language.
struct FormulaEffect {
    /// A number in the formula, which a diagnosis may fit.
    struct Parameter {
        std::string name = {};      ///< in the formula
        std::string unit = {};      ///< empty for a pure number
        double low = 0.0;           ///< bounds, both included
        double high = 0.0;          ///< the largest value that is tried
        double vanishing = 0.0;     ///< without effect; of what only shapes the effect, any value
        double typical = 0.0;       ///< where none is given
        std::string role = "size";  ///< size | shape | optional
        /// Of a shape: from which a fit may begin; empty: spread over the bounds.
        std::vector<double> starts = {};
        std::string text = {};  ///< what it is, for people

        bool operator==(const Parameter&) const = default;
    };

    /// A quantity that remembers, known to the formula by its name.
    struct Memory {
        /// What is remembered.
        enum class Kind {
            state,  ///< its derivative by the time is `of`, per s
            play,   ///< follows `of` as soon as that is half of `by` ahead of it
            delay,  ///< what `of` was `by` seconds ago
        };
        std::string name = {};    ///< in the formula
        Kind kind = Kind::state;  ///< what is remembered of it
        std::string of = {};      ///< the variable or formula that it follows
        std::string by = {};      ///< of parameters alone; unused by states

        bool operator==(const Memory&) const = default;
    };

    std::string name = {};                   ///< by which it is called
    std::string block = {};                  ///< e.g. "macro.friction"
    std::string acts_on = {};                ///< the port, e.g. "macro.friction"
    std::string formula = {};                ///< what it adds there, in the port's unit
    std::vector<Parameter> parameters = {};  ///< its numbers
    std::vector<Memory> memories = {};       ///< what it remembers
    std::string text = {};                   ///< what it is, for people
    std::string source = {};                 ///< where that is from

    bool operator==(const FormulaEffect&) const = default;
};

}  // namespace fidservo
