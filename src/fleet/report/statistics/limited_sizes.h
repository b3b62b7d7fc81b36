// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The sizes of shares, where some levels are known only to be below a limit (censored.h).
//
// Which sets have shares is decided with normal distributions about 0 in place of such levels
// (attribution.h). Sizes estimated in this way would be biased towards 0, since a unit that is never named is
// only known to be below its limit. The sizes therefore maximise
//
//     product over u of  N(y_u; X_u m, V_u)  or
//         Phi((L_u - X_u m)/sqrt(V_u)) - Phi((-L_u - X_u m)/sqrt(V_u)),
//
// with V_u = s_u^2 + tau^2, times their priors N(m_j; 0, g_j^2), at the tau at which the integral of this
// product over m is largest (Laplace's method). The logarithm is concave in m and is maximised by Newton's
// method with step halving. Sources: Tobin, Econometrica 26, 1958; Tierney, Kadane, JASA 81, 1986.
#include "src/fleet/report/statistics/explanation.h"
#include "src/fleet/report/statistics/point.h"

#include <span>
#include <vector>

namespace fidservo::fleet {

/// The sizes of the shares.
struct LimitedSizes {
    std::vector<Level> sizes;     ///< of each share, floors, given the others
    double spread = 0.0;          ///< tau
    double log_likelihood = 0.0;  ///< with sizes and tau integrated out
    std::vector<double> levels;   ///< of each unit: its value, or its expected value given its limit; floors
};

LimitedSizes limited_sizes(std::span<const Level> levels, const TakenShares& taken);

}  // namespace fidservo::fleet
