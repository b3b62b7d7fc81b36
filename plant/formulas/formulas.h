// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The formulas that act at one site of a plant, with the values of their parameters, and what they remember.
//
// A site hands over its variables (plant/formulas/port.h); each port's value is the sum of its formulas.
// Where none acts nothing is evaluated. Quantities that remember go on once a tick, T, at its beginning, from
// what the site's variables x are then, and keep their values during it:
//
//     state   z' = r(z, x), by the exponential Euler method, z += T r phi(T dr/dz), phi(a) = (e^a - 1) / a:
//     exact
//             where r is linear in z (Hochbruck, Ostermann, Acta Numerica 19, 2010). Starts where r = 0, as a
//             machine does that has stood for long, or at 0
//     play    z moves as little as keeps it within half the width of x (a play operator). Starts at x
//     delay   what x was, by straight lines between ticks. Before the start it was what it is there
#include "plant/formulas/formula_code.h"

#include <array>
#include <bitset>
#include <cstddef>
#include <span>
#include <vector>

namespace fidservo::plant {

struct FormulaTerm {
    const FormulaCode* code;
    std::vector<double> parameters;
    std::size_t first_memory;  ///< of its own, among those of the site
};

/// What the formulas of a site remember. A plain value.
struct FormulaMemory {
    std::array<double, most_memories> values{};  ///< during this tick
    std::array<double, most_memories> next{};    ///< of states: at the beginning of the next one
    std::vector<double> past;                    ///< of delays: a ring each, one after the other
    std::size_t ticks = 0;                       ///< that were begun
    double tick_s = 0.0;                         ///< for which the rings are made
};

class Formulas {
  public:
    /// Nothing is added where all sizes vanish. Throws InputError where there are too many that remember.
    /// @param parameters  of the effect, in its order
    void add(const FormulaCode& code, std::span<const double> parameters);

    bool any() const { return !terms_.empty(); }
    bool act(Port port) const { return acting_.test(static_cast<std::size_t>(port)); }
    bool remember() const { return memories_ > 0; }
    bool use(std::size_t variable) const { return used_.test(variable); }

    /// The sum at a port. Throws InputError where a formula gives no number, or more than any machine has
    /// (PortDescription::limit).
    double value(Port port, std::span<const double> variables, const FormulaMemory& memory) const;

    /// What a machine remembers on which the variables have been what they are for long.
    FormulaMemory start(std::span<const double> variables, double tick_s) const;
    /// Begins a tick. Does not allocate. In one of another length than at the start delays stay what they
    /// are: so one looks at what is between ticks.
    void begin_tick(FormulaMemory& memory, std::span<const double> variables, double tick_s) const;

  private:
    static void begin_tick(const FormulaTerm& term, FormulaMemory& memory, std::span<const double> variables,
                           double tick_s, std::size_t& ring);

    std::vector<FormulaTerm> terms_;
    std::bitset<port_count> acting_;
    std::bitset<most_variables> used_;
    std::size_t memories_ = 0;
};

}  // namespace fidservo::plant
