// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

namespace fidservo::selfcheck {

/// A fraction of counts.
struct Share {
    std::size_t hits = 0, of = 0;

    void add(bool hit) {
        hits += hit ? 1 : 0;
        ++of;
    }
    /// hits / of; NaN for of = 0.
    double value() const;
};

struct Interval {
    double low, high;
};

/// Wilson's 95 % confidence interval of a binomial probability: all p with |hits - of p| <= z sqrt(of p (1 -
/// p)), z = 1.96. [0, 1] for of = 0. Source: Wilson, J. Am. Stat. Assoc. 22 (1927); Newcombe, Statistics in
/// Medicine 17 (1998), method 3.
Interval wilson_interval(const Share& share);

}  // namespace fidservo::selfcheck
