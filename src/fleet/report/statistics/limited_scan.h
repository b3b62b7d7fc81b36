// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The likelihood of a change at each time where some diagnoses do not name the quantity (censored.h).
//
//     E_k = sum_phi w(phi) int dmu prod_{t<k} f_t(mu) int ddelta w(delta) prod_{t>=k} f_t(mu + delta c_t)
//           / sum_phi w(phi) int dmu prod_t f_t(mu),       f_t with the variance phi (s_t^2 + sigma^2)
//
// c is the change's column (change_scan.h), the weights of phi and delta those of change_points.h. The
// integral over delta is in closed form where all diagnoses since k name it.
#include "src/fleet/report/statistics/change_scan.h"

#include <span>

namespace fidservo::fleet {

/// E_k for every k, without other changes. In place of the likelihood of a change's best size, the mean over
/// sizes is returned.
/// @param scatter  with degrees other than 0
ChangeScan scan_with_limits(std::span<const Point> points, const Scatter& scatter);

}  // namespace fidservo::fleet
