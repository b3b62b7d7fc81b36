// SPDX-License-Identifier: GPL-3.0-or-later
// Windows in which the position within a count decides into which direction the carriage goes.
#include "gap/verdict/unpredictable.h"

#include "core/rig.h"
#include "gap/diagnose.h"
#include "gap/search/search.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using testing::recordings_of;

std::ptrdiff_t unpredictable(const Evidence& evidence, const Hypothesis& hypothesis) {
    CrossFit fitted{{hypothesis, hypothesis}, {}, 0.0};
    fitted.mean_squares = mean_squares(evidence.windows(), evidence.errors(hypothesis, everything(evidence)));
    return std::ranges::count(unpredictable_windows(evidence, fitted), true);
}

TEST(Unpredictable, RigAsItsFileSays_GoesWhereItIsPredictedTo) {
    const Evidence evidence(reference_rig(), recordings_of({}, {"macro-pulses", "macro-square", "rest"}));
    EXPECT_EQ(unpredictable(evidence, {}), 0);
}

/// The error of a wrong model does not depend on where the window began.
TEST(Unpredictable, ErrorsOfAnotherModel_AreNoneOfTheStart) {
    const Evidence evidence(
        reference_rig(), recordings_of(effects({"drive_gain:factor=0.9"}), {"macro-pulses", "macro-square"}));
    EXPECT_EQ(unpredictable(evidence, {}), 0);
}

/// The force along the rail is as large as what the dead zone leaves of the commands: the carriage hangs on
/// its waves, and starts from rest.
TEST(Unpredictable, RigWithAStatedForceAlongTheRail_HasNoGap) {
    Rig rig = reference_rig();
    rig.effects.push_back(
        {"cogging", {{"amplitude_V", 0.4234}, {"period_mm", 3.5356}, {"phase_rad", -1.49}}});
    const Evidence evidence(rig, recordings_of({}, {"macro-pulses", "macro-square", "macro-sweep"}, rig));
    const Diagnosis diagnosis =
        diagnose(evidence, {.only = {"drive_gain", "coulomb_friction"}, .without = {}, .selection = {}});
    EXPECT_EQ(diagnosis.verdict, Verdict::no_gap);
    EXPECT_LT(diagnosis.gap.before, 1.1);
}

}  // namespace

}  // namespace fidservo
