// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "gap/fit/cross_fit.h"

namespace fidservo::testing {

/// The explanation that names nothing, judged on all windows.
inline gap::CrossFit nothing_named(const gap::Evidence& evidence) {
    const gap::CrossFitter fitter(evidence, evidence.windows().size(), [] { return false; });
    gap::CrossFit nothing{.of_half = {}, .mean_squares = {}};
    fitter.judge(nothing);
    return nothing;
}

}  // namespace fidservo::testing
