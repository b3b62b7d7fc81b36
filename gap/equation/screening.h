// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Selects the terms of a port that predict the residuals of an explanation, by sparse regression.
//
// The effect of a term on the prediction is linear in its coefficient while that is small. The term's column
// in the regression is, for the carriage, the mean force over short supports, in the weak form
// (gap/balance/carriage_forces.h), which needs no simulation; elsewhere it is the change of the prediction
// for a small coefficient. Terms are added one after the other as long as held-out errors decrease
// significantly (gap/fit/regression.h), and kept if they are selected again, with the same sign, on most
// random halves of the recordings (stability selection: Meinshausen, Buehlmann, J. Royal Statistical Society
// B 72, 2010).
#include "gap/equation/sketch.h"
#include "gap/evidence.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::gap {

/// Fraction of the random halves in which a term has to be selected.
inline constexpr double least_share_of_halves = 0.8;

/// The terms of a port as additions to an explanation; each term's effect on the predictions is computed
/// once.
class PortScreening {
  public:
    /// @param base  the explanation to which terms are added
    /// @param errors  of the base; NaN where they are not judged
    PortScreening(const Evidence& evidence, const Hypothesis& base, const Errors& errors, plant::Port port,
                  std::vector<Term> terms);
    ~PortScreening();
    PortScreening(PortScreening&&) noexcept;

    /// The terms that predict held-out data significantly and are selected on most random halves; empty if
    /// there are none.
    /// @param tail  probability of selecting anything where there is nothing
    std::optional<Sketch> sketch(double tail) const;

    /// The single terms that are most promising, best first. They help where an effect is so large that its
    /// linear part says little.
    std::vector<Sketch> leading(std::size_t count) const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace fidservo::gap
