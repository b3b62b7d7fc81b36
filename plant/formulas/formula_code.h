// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A formula effect after parsing: its port, and its expressions ready to be evaluated.
//
// Expressions are muParser's, in its own locale: numbers, names, + - * / ^, comparisons, && ||, c ? a : b,
// and the functions abs, sign, sqrt, exp, log, sin, cos, tan, tanh, atan2, min, max, clip(x, low, high),
// if(c, a, b); pi. Neither assignments nor strings. a ^ b binds tighter than a sign before a, and -x^2 is
// -(x^2).
#include "core/formula_effect.h"
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
    /// The width of a play, in the unit of its input, or the time of a delay in s. Throws InputError "NAME:
    /// KEY: what is wrong; what is allowed" where it is below 0 or no number, or a delay longer than
    /// longest_delay_s.
    double extent(std::size_t memory, std::span<const double> parameters) const;

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
