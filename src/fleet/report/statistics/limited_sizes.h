// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The sizes of shares, where some levels are known only to be below a limit (censored.h).
//
// Which sets have shares is decided with normal laws about 0 in the place of such levels. To take sizes from
// these would draw them to 0: that a unit is never named says that it is below its limit, and no more. So the
// sizes maximise
//
//     product over u of  N(y_u; X_u m, V_u)  or  Phi((L_u - X_u m)/sqrt(V_u)) - Phi((-L_u - X_u
//     m)/sqrt(V_u)),
//
// V_u = s_u^2 + tau^2, times their laws N(m_j; 0, g_j^2), at the tau at which the integral of that over m is
// largest, by Laplace's method. The logarithm is concave in m: Newton's steps, halved where they go too far.
// Sources: Tobin, Econometrica 26, 1958; Tierney, Kadane, JASA 81, 1986.
#include "src/fleet/report/statistics/explanation.h"
#include "src/fleet/report/statistics/point.h"

#include <span>
#include <vector>

namespace fidservo::fleet {

/// What the shares come to.
struct LimitedSizes {
    std::vector<Level> sizes;     ///< of each share, given the others
    double spread = 0.0;          ///< tau
    double log_likelihood = 0.0;  ///< with sizes and tau integrated out
    std::vector<double> levels;   ///< of each unit: its value, or the mean of what it may be
};

LimitedSizes limited_sizes(std::span<const Level> levels, const TakenShares& taken);

}  // namespace fidservo::fleet
