// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which terms of a port predict what an explanation leaves: sparse regression.
//
// What a term does to the prediction is linear in its coefficient while that is small. Of the carriage it is
// the mean of the force over short supports, in the weak form (gap/balance/carriage_forces.h), for which
// nothing has to be followed; elsewhere it is by how much the prediction changes with a little of the term.
// Terms are taken in one after the other while held-out errors get smaller beyond chance
// (gap/fit/regression.h), and kept where they are taken in again, with the same sign, on most random halves
// of the recordings (stability selection: Meinshausen, Buehlmann, J. Royal Statistical Society B 72, 2010).
#include "gap/equation/sketch.h"
#include "gap/evidence.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Share of the random halves in which a term has to be taken in again.
inline constexpr double least_share_of_halves = 0.8;

/// A port's terms beside an explanation: what each does to the predictions is worked out once.
class PortScreening {
  public:
    /// @param base  explains all but what is looked for
    /// @param errors  of the base; NaN where they are not judged
    PortScreening(const Evidence& evidence, const Hypothesis& base, const Errors& errors, plant::Port port,
                  std::vector<Term> terms);
    ~PortScreening();
    PortScreening(PortScreening&&) noexcept;

    /// The terms that predict what was not fitted, beyond chance and on most random halves; none where none
    /// does.
    /// @param tail  of taking in anything where there is nothing
    std::optional<Sketch> sketch(double tail) const;

    /// The terms that promise most alone, best first: where an effect is large, what is linear of it may say
    /// little.
    std::vector<Sketch> leading(std::size_t count) const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace fidservo::gap
