// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/tally/binomial.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::selfcheck {

double Share::value() const {
    return of > 0 ? static_cast<double>(hits) / static_cast<double>(of)
                  : std::numeric_limits<double>::quiet_NaN();
}

Interval wilson_interval(const Share& share) {
    if (share.of == 0) return {0.0, 1.0};
    constexpr double z = 1.959963984540054;
    const auto n = static_cast<double>(share.of);
    const double p = share.value();
    const double scale = 1.0 / (1.0 + z * z / n);
    const double centre = scale * (p + z * z / (2.0 * n));
    const double reach = scale * z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
    return {std::max(0.0, centre - reach), std::min(1.0, centre + reach)};
}

}  // namespace fidservo::selfcheck
