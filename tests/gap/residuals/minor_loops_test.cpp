// SPDX-License-Identifier: GPL-3.0-or-later
// Errors that are made on minor loops of the hysteresis, and elsewhere.
#include "gap/residuals/minor_loops.h"

#include "core/rig.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

/// For each row, whether the wire has turned back between its end states since it was at one of them.
std::vector<bool> has_turned(const gap::Course& course, double stroke_mm) {
    constexpr double at_end = 0.05, turn_degC = 3.0;
    std::vector<bool> turned;
    bool is_turned = false, was_cold = true;
    float extreme_degC = course.temperature_degC.front();
    for (std::size_t k = 0; k < course.temperature_degC.size(); ++k) {
        const float degC = course.temperature_degC[k];
        const double share = course.contraction_mm[k] / stroke_mm;
        if (share < at_end || share > 1.0 - at_end) {
            was_cold = share < at_end;
            is_turned = false;
            extreme_degC = degC;
        }
        extreme_degC = was_cold ? std::max(extreme_degC, degC) : std::min(extreme_degC, degC);
        is_turned = is_turned || std::abs(extreme_degC - degC) > turn_degC;
        turned.push_back(is_turned);
    }
    return turned;
}

/// Errors in floors, on minor loops and elsewhere.
Errors errors_of(const Evidence& evidence, float on_minor_loops, float elsewhere) {
    Errors errors = evidence.errors({}, everything(evidence));
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::hall) continue;
        const std::vector<bool> turned =
            has_turned(evidence.course(window.run), evidence.rig().micro->fod->stroke_mm());
        for (std::size_t k = 0; k < window.rows; ++k)
            errors[window.begin + k] = turned[window.first_row + k] ? on_minor_loops : elsewhere;
    }
    return errors;
}

TEST(MinorLoops, ErrorsOnTheseAlone_AreTheHysteresisMemory) {
    const Evidence evidence = testing::campaign({}, {"micro-triangle", "micro-steps"});
    EXPECT_TRUE(only_minor_loops_are_off(evidence, errors_of(evidence, 20.0F, 1.0F)));
    EXPECT_FALSE(only_minor_loops_are_off(evidence, errors_of(evidence, 20.0F, 20.0F)));
    EXPECT_FALSE(only_minor_loops_are_off(evidence, errors_of(evidence, 1.0F, 20.0F)));
    EXPECT_FALSE(only_minor_loops_are_off(evidence, errors_of(evidence, 1.0F, 1.0F)));
}

TEST(MinorLoops, RecordingsWithoutThem_SayNothing) {
    const Evidence evidence = testing::campaign({}, {"rest"});
    EXPECT_FALSE(only_minor_loops_are_off(evidence, errors_of(evidence, 20.0F, 1.0F)));
}

}  // namespace
}  // namespace fidservo
