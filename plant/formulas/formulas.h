// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The formulas that act at one site of a plant, with the values of their parameters and their memories.
//
// A site hands over its variables (plant/formulas/port.h); each port's value is the sum of its formulas.
// Where none acts nothing is evaluated. Memories are updated once a tick of length T, at its beginning, from
// the site's variables x at that time, and keep their values during the tick:
//
//     state   z' = r(z, x), by the exponential Euler method, z += T r phi(T dr/dz), phi(a) = (e^a - 1) / a:
//     exact
//             where r is linear in z (Hochbruck, Ostermann, Acta Numerica 19, 2010). Starts where r = 0, as a
//             machine does that has stood for long, or at 0
//     play    z moves as little as keeps it within half the width of x (a play operator). Starts at x
//     delay   what x was, by straight lines between ticks. Before the start it was what it is there
#include "core/input_error.h"
#include "plant/formulas/formula_code.h"

#include <array>
#include <bitset>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace fidservo::plant {

/// A formula that yields a value at run time that no machine has.
class FormulaValueError : public InputError {
  public:
    /// @param what  one line for the user that names effect, value and what is allowed
    FormulaValueError(std::string effect, const std::string& what)
        : InputError(what), effect_(std::move(effect)) {}

    const std::string& effect() const { return effect_; }

  private:
    std::string effect_;
};

struct FormulaTerm {
    const FormulaCode* code;
    std::vector<double> parameters;
    std::size_t first_memory;  ///< index of its first memory among those of the site
};

/// The state of the memories of a site's formulas. A plain value.
struct FormulaMemory {
    std::array<double, most_memories> values{};  ///< values that hold during this tick
    std::array<double, most_memories> next{};    ///< of states: values at the beginning of the next tick
    std::vector<double> past;                    ///< of delays: a ring buffer for each, one after the other
    std::size_t ticks = 0;                       ///< number of ticks begun
    double tick_s = 0.0;                         ///< tick length for which the ring buffers were made
};

class Formulas {
  public:
    /// Adds a formula; one that is there already gets new values in its place. It is absent where all sizes
    /// vanish. Throws InputError where there are too many memories.
    /// @param parameters  those of the effect, in its order
    void add(const FormulaCode& code, std::span<const double> parameters);

    bool any() const { return !terms_.empty(); }
    bool act(Port port) const { return acting_.test(static_cast<std::size_t>(port)); }
    bool remember() const { return memories_ > 0; }
    bool use(std::size_t variable) const { return used_.test(variable); }

    /// The sum of the formulas at a port. Throws FormulaValueError where a formula yields NaN or infinity, or
    /// more than any machine has (PortDescription::limit).
    double value(Port port, std::span<const double> variables, const FormulaMemory& memory) const;

    /// The same without a limit, for states that a computation only tries.
    double any_value(Port port, std::span<const double> variables, const FormulaMemory& memory) const;

    /// The memories' state after the variables have had the given values for a long time.
    FormulaMemory start(std::span<const double> variables, double tick_s) const;
    /// Begins a tick: updates the memories. Does not allocate. If the tick's length differs from that at the
    /// start, delays are not updated: this serves looking at a time between ticks.
    void begin_tick(FormulaMemory& memory, std::span<const double> variables, double tick_s) const;

  private:
    void take_in(FormulaTerm term);
    static void begin_tick(const FormulaTerm& term, FormulaMemory& memory, std::span<const double> variables,
                           double tick_s, std::size_t& ring);

    std::vector<FormulaTerm> terms_;
    std::bitset<port_count> acting_;
    std::bitset<most_variables> used_;
    std::size_t memories_ = 0;
};

}  // namespace fidservo::plant
