// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The benchmark's outcome as one self-contained page.
#include "tests/tag_precision/precision_trials.h"

#include <string>
#include <vector>

namespace fidservo::bench {

/// Figures of one method, in the order of the cases.
struct MethodFigures {
    std::string name;
    std::vector<precision::PrecisionFigures> cases;
};

/// Medians over the same 1280 x 960 frames, one core.
struct FrameTimes {
    double refinement_ms, refinement_p99_ms;
    double detector_ms;
};

/// @param methods  the refinement first
std::string precision_page(const std::vector<precision::PrecisionCase>& cases,
                           const std::vector<MethodFigures>& methods, const FrameTimes& times);

/// Root mean square of the error of both coordinates, bias included.
double rms_px(const precision::PrecisionFigures& figures);

}  // namespace fidservo::bench
