#pragma once
// Which terms of a port predict what an explanation leaves: sparse regression.
//
// What a term does to the prediction is linear in its coefficient while that is small. Of the carriage it is
// the mean of the force over short supports, in the weak form (gap/balance/carriage_forces.h), for which
// nothing has to be followed; elsewhere it is by how much the prediction changes with a little of the term.
// Terms are taken in one after the other while held-out errors get smaller beyond chance
// (gap/fit/regression.h), and kept where they are taken in again, with the same sign, on most random halves
// of the recordings (stability selection: Meinshausen, Buehlmann, J. Royal Statistical Society B 72, 2010).
#include "gap/equation/terms.h"
#include "gap/evidence.h"

#include <optional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Terms of a port in the order in which they were taken in, with first values of their coefficients: one for
/// each of Term::texts, one term after the other.
struct Sketch {
    plant::Port port = plant::Port::force;
    std::vector<Term> terms;
    std::vector<double> coefficients;

    std::size_t shapes() const;
};

/// The most that an equation has.
inline constexpr std::size_t most_coefficients = 4, most_equation_shapes = 2;

/// Share of the random halves in which a term has to be taken in again.
inline constexpr double least_share_of_halves = 0.8;

/// @param base  explains all but what is looked for
/// @param errors  of the base; NaN where they are not judged
/// @param tail  of taking in anything where there is nothing
/// @return none where no term of the port predicts anything, or none is taken in again
std::optional<Sketch> sketch_of(const Evidence& evidence, const Hypothesis& base, const Errors& errors,
                                plant::Port port, const std::vector<Term>& terms, double tail);

}  // namespace fidservo::gap
