// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How terms are put together: powers, products, steps, bells, waves, lags of a variable that is known.
#include "gap/equation/terms.h"

#include <string>
#include <vector>

namespace fidservo::gap {

/// A variable of a port, with what the recordings cover of it.
struct KnownVariable {
    std::string name;
    std::string unit;
    Covered range;
    std::string words;  ///< in a sentence

    /// Within what is covered, whose ends are rounded outwards to steps.
    std::string clipped() const;
    /// The middle of what is covered; 0 where that has both signs.
    double origin() const;
    /// `clipped`, minus the origin.
    std::string centred() const;
    /// Its largest magnitude.
    double most() const;
    /// How far from the origin it goes.
    double reach() const;
    std::string power_unit(int power) const;

  private:
    /// A hundredth of what is covered, or less.
    double step() const;
};

/// The terms of a port, as they are added.
class TermLibrary {
  public:
    const std::vector<Term>& terms() const { return terms_; }

    void add(std::string text, std::string unit, double size, std::string words);
    /// @param factor  of order 1; empty: 1
    void add_constant(const std::string& factor, const std::string& words);
    /// Powers of a variable, from 1 to the highest, 3 at most, the higher ones about its origin, squares
    /// about other centres as well, which are a shape; times a factor of order 1.
    void add_powers(const KnownVariable& of, int highest, const std::string& factor = {});
    void add_product(const KnownVariable& left, const KnownVariable& right);
    /// The same function with several values of its shape.
    /// @param texts  with `shape` in them
    /// @param shape  its value is not read
    void add_shaped(const std::vector<std::string>& texts, const TermShape& shape,
                    std::span<const double> values, const std::string& words);
    /// Sine and cosine of a place, of each period.
    void add_waves(const std::string& variable, std::span<const double> periods_mm,
                   const std::string& factor = {});
    /// Where a step or a bell may be.
    struct Bend {
        double width, centre;
    };
    /// Steps, tanh, and bells, exp(-x^2), of a variable; widths and centres are shapes.
    void add_steps_and_bells(const KnownVariable& of, std::span<const Bend> bends,
                             const std::string& factor = {});
    /// The same, a wide one about the middle of what is covered and narrow ones over all of it.
    void add_steps_and_bells(const KnownVariable& of);
    /// What begins at a value of a variable, which is a shape.
    /// @param text  with `shape` in it
    void add_knees(const std::string& text, const KnownVariable& of, const std::string& words);
    /// exp(-time / shape), times a factor of order 1.
    void add_fading(const std::string& factor, const std::string& words);
    /// What a variable was a while ago less what it is.
    /// @param shape  the delay in s; its value is not read
    void add_delayed(const KnownVariable& of, const TermShape& shape, std::span<const double> delays_s);
    /// What follows a variable with a time constant less what it is.
    /// @param shape  the time constant in s; its value is not read
    void add_lagging(const KnownVariable& of, const TermShape& shape,
                     std::span<const double> time_constants_s);

  private:
    /// A term that does something and whose shapes have somewhere to go: of a variable that did not vary
    /// there is none.
    void keep(Term term);
    void add_squares_elsewhere(const KnownVariable& of, const std::string& factor);
    void add_remembering(const FormulaEffect::Memory& memory, const KnownVariable& of, const TermShape& shape,
                         std::span<const double> values, const std::string& words);

    std::vector<Term> terms_;
    int next_family_ = 0;
};

}  // namespace fidservo::gap
