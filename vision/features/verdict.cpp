// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/verdict.h"

#include "core/demand.h"

#include <cmath>
#include <cstdlib>

namespace fidservo::vision {

namespace {

/// Pass if the excess over the limit is certainly not positive, fail if it certainly is.
Verdict decide_excess(double excess, double guard) {
    if (excess + guard <= 0.0) return Verdict::pass;
    if (excess - guard > 0.0) return Verdict::fail;
    return Verdict::not_decidable;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::pass:
            return "pass";
        case Verdict::fail:
            return "fail";
        case Verdict::not_decidable:
            return "not_decidable";
    }
    std::abort();
}

Verdict decide(const Measured& measured, double nominal, double tolerance, double coverage_factor) {
    FIDSERVO_DEMAND(measured.std >= 0.0 && tolerance >= 0.0 && coverage_factor >= 0.0);
    return decide_excess(std::abs(measured.value - nominal) - tolerance, coverage_factor * measured.std);
}

Verdict decide_at_least(const Measured& measured, double least, double coverage_factor) {
    FIDSERVO_DEMAND(measured.std >= 0.0 && coverage_factor >= 0.0);
    return decide_excess(least - measured.value, coverage_factor * measured.std);
}

}  // namespace fidservo::vision
