// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The construction of terms: powers, products, steps, bells, waves and lags of variables.
#include "gap/equation/terms.h"

#include <array>
#include <string>
#include <vector>

namespace fidservo::gap {

/// A variable of a port, with the range that the recordings cover.
struct KnownVariable {
    std::string name;
    std::string unit;
    Covered range;
    std::string words;  ///< its name in a sentence

    /// An expression for the variable clipped to the covered range, whose ends are rounded outwards to steps.
    std::string clipped() const;
    /// The reference value of powers: the middle of the covered range, or 0 if the range includes both signs.
    double origin() const;
    /// An expression: clipped() minus origin().
    std::string centred() const;
    /// Its largest magnitude in the covered range.
    double most() const;
    /// Its largest distance from the origin.
    double reach() const;
    std::string power_unit(int power) const;

  private:
    /// The step to which numbers are rounded: a hundredth of the covered range, or less.
    double step() const;
};

/// Start values and range of the time constant of what is slow.
inline constexpr std::array slow_constants_s{3.0, 10.0, 30.0};
inline constexpr double shortest_slow_s = 0.3, longest_slow_s = 300.0;

/// Collects the terms of a port.
class TermLibrary {
  public:
    const std::vector<Term>& terms() const { return terms_; }

    void add(std::string text, std::string unit, double size, std::string words);
    /// @param factor  an expression of order 1; empty: 1
    void add_constant(const std::string& factor, const std::string& words);
    /// Adds powers of a variable, from 1 to `highest` (3 at most), the higher ones about its origin; also
    /// squares about other centres, which are a shape. All are multiplied by a factor of order 1.
    void add_powers(const KnownVariable& of, int highest, const std::string& factor = {});
    void add_product(const KnownVariable& left, const KnownVariable& right);
    /// Adds one function with several start values of its shape.
    /// @param texts  expressions that contain `shape`
    /// @param shape  its unit and its range; its value is not used
    void add_shaped(const std::vector<std::string>& texts, const TermShape& shape,
                    std::span<const double> values, const std::string& words);
    /// Adds sine and cosine of a position, for each period.
    void add_waves(const std::string& variable, std::span<const double> periods_mm,
                   const std::string& factor = {});
    /// Width and centre of a step or a bell.
    struct Bend {
        double width, centre;
    };
    /// Adds steps (tanh) and bells (exp(-x^2)) of a variable; widths and centres are shapes.
    void add_steps_and_bells(const KnownVariable& of, std::span<const Bend> bends,
                             const std::string& factor = {});
    /// Adds a wide step and bell in the middle of the covered range, and narrow ones over all of it.
    void add_steps_and_bells(const KnownVariable& of);
    /// Adds functions that begin at a value of a variable, which is a shape.
    /// @param text  an expression that contains `shape`
    void add_knees(const std::string& text, const KnownVariable& of, const std::string& words);
    /// Adds exp(-time / shape), times a factor of order 1.
    void add_fading(const std::string& factor, const std::string& words);
    /// Adds the value of a variable a while ago minus its present value.
    /// @param shape  unit and range of the delay in s; its value is not used
    void add_delayed(const KnownVariable& of, const TermShape& shape, std::span<const double> delays_s);
    /// Adds the variable behind a first-order lag minus its present value.
    /// @param shape  unit and range of the time constant in s; its value is not used
    void add_lagging(const KnownVariable& of, const TermShape& shape,
                     std::span<const double> time_constants_s);

  private:
    /// Adds a term if it is not constant zero and its shapes have a range: a variable that did not vary in
    /// the recordings gives no term.
    void keep(Term term);
    void add_squares_elsewhere(const KnownVariable& of, const std::string& factor);
    void add_remembering(const FormulaEffect::Memory& memory, const KnownVariable& of, const TermShape& shape,
                         std::span<const double> values, const std::string& words);

    std::vector<Term> terms_;
    int next_family_ = 0;
};

}  // namespace fidservo::gap
