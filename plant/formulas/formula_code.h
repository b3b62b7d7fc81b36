// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A formula effect after parsing: its port, and its expressions ready to be evaluated.
//
// Expressions are muParser's, in its own locale: numbers, names, + - * / ^, comparisons, && ||, c ? a : b,
// and the functions abs, sign, sqrt, exp, log, sin, cos, tan, tanh, atan2, min, max, clip(x, low, high),
// if(c, a, b); pi. Neither assignments nor strings. a ^ b binds tighter than a sign before a, and -x^2 is
// -(x^2).
#include "core/formula_effect.h"
#include "core/input_error.h"
#include "plant/formulas/port.h"

#include <bitset>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace fidservo::plant {

inline constexpr std::size_t most_memories = 8;  ///< at one site
inline constexpr std::size_t most_formula_parameters = 16;
inline constexpr double longest_delay_s = 10.0;

/// What a formula gives, with the values of its parameters, no machine has: "NAME: KEY: what; allowed".
class FormulaFault : public InputError {
  public:
    /// @param effect  its name
    /// @param what  the rest of the message
    FormulaFault(const std::string& effect, const std::string& what)
        : InputError(effect + ": " + what), effect_(effect) {}

    const std::string& effect() const { return effect_; }
    std::string rest() const { return what() + effect_.size() + 2; }  ///< the message behind the name

  private:
    std::string effect_;
};

class FormulaCode {
  public:
    /// The parsed form of a text. It is made at the first call, and lives until the program ends. May be
    /// called from several threads. Throws InputError "NAME: KEY: what is wrong; what is allowed".
    static const FormulaCode& of(const FormulaEffect& effect);

    const FormulaEffect& effect() const { return effect_; }
    const PortDescription& port() const { return *port_; }
    /// Whether any of its expressions uses a variable of its site, given by its index.
    bool uses(std::size_t variable) const { return used_.test(variable); }
    /// The names of the variables that its expressions use, in the site's order.
    std::vector<std::string> variable_names() const;

    /// The values of its parameters for a message: " with drag = 5e-06, ...".
    std::string at_values(std::span<const double> parameters) const;

    /// The formula's value. May be called from several threads: each has its own parser.
    /// @param variables  those of the site, in their order
    /// @param memories  those of this effect, in their order
    /// @param parameters  those of this effect, in their order
    double value(std::span<const double> variables, std::span<const double> memories,
                 std::span<const double> parameters) const;
    /// The value of the expression that a memory follows: the rate per s of a state, or the input of a play
    /// or a delay.
    double followed(std::size_t memory, std::span<const double> variables, std::span<const double> memories,
                    std::span<const double> parameters) const;
    /// The width of a play, in the unit of its input, or the time of a delay in s.
    double extent(std::size_t memory, std::span<const double> parameters) const;
    /// Throws FormulaFault if a width is below 0, a delay below 0 or above longest_delay_s, or either no
    /// number.
    void demand_extents(std::span<const double> parameters) const;

  private:
    explicit FormulaCode(const FormulaEffect& effect);
    class Machine;
    Machine& machine() const;

    FormulaEffect effect_;
    const PortDescription* port_;
    std::bitset<most_variables> used_;
    std::size_t id_ = 0;
};

}  // namespace fidservo::plant
