// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The formulas that act at one site of a plant, with the values of their parameters and their memories.
//
// A site hands over its variables (plant/formulas/port.h); each port's value is the sum of its formulas.
// Where none acts nothing is evaluated. Memories are updated once a tick of length T, at its beginning, from
// the site's variables x at that time, and keep their values during the tick:
//
//     state   z' = r(z, x), by the exponential Euler method, z += T r phi(T dr/dz), phi(a) = (e^a - 1) / a,
//             which is exact if r is linear in z (Hochbruck, Ostermann, Acta Numerica 19, 2010). Its start
//             value is that with r = 0, as of a machine that has stood for long, or else 0
//     play    z is kept within half the width of x by the smallest motion (a play operator). Starts at x
//     delay   x at an earlier time, linearly interpolated between ticks; before the start, x at the start
#include "plant/formulas/formula_code.h"

#include <array>
#include <bitset>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace fidservo::plant {

struct FormulaTerm {
    const FormulaCode* code;
    std::vector<double> parameters;
    std::size_t first_memory;  ///< index of its first memory among those of the site
    std::string stated_at;     ///< StatedEffect::stated_at, or empty
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
    /// vanish. Throws InputError where there are too many memories, and where FormulaCode::demand_extents()
    /// does.
    /// @param parameters  those of the effect, in its order
    /// @param stated_at  as in StatedEffect: with it an error is "STATED_AT.KEY: ...", else a FormulaFault
    void add(const FormulaCode& code, std::span<const double> parameters, const std::string& stated_at = {});

    bool any() const { return !terms_.empty(); }
    bool act(Port port) const { return acting_.test(static_cast<std::size_t>(port)); }
    bool remember() const { return memories_ > 0; }
    bool use(std::size_t variable) const { return used_.test(variable); }

    /// The sum of the formulas at a port. Throws as add() does where a formula yields NaN or infinity, or
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
