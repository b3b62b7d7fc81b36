// SPDX-License-Identifier: GPL-3.0-or-later
// A real machine, by other people: the linear motor of Janot, Gautier and Brunot's EMPS data set.
#include "core/rig.h"
#include "gap/balance/carriage_forces.h"
#include "gap/diagnose.h"
#include "src/files/rig/rig_file.h"
#include "tests/campaign.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using ::testing::Contains;
using testing::read_all;
using ::testing::SizeIs;

/// R.m.s. of the force that predictions lack, over that of the motor's, where the carriage slides.
double relative_force_error(const Evidence& evidence, const Hypothesis& hypothesis) {
    const Errors errors = evidence.errors(hypothesis, everything(evidence));
    const CarriageForces forces(evidence, errors, short_half_support, 0.0);
    const Column motor = forces.of_force(0, [](const SlidingRow& at) { return at.command_V; });
    double lacking = 0.0, all = 0.0;
    for (std::size_t support = 0; support < motor.values.size(); ++support) {
        lacking += std::pow(forces.lacking()[support], 2.0);
        all += std::pow(motor.values[support], 2.0);
    }
    return std::sqrt(lacking / all);
}

class SlowEmps : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "the shared data are absent";
    }
    const std::filesystem::path folder = std::filesystem::path(FIDSERVO_DATA_DIR) / "emps";
};

TEST_F(SlowEmps, FrictionIsNamedAndTheScrewsRippleIsFoundInWhatRemains) {
    const Rig rig = load_rig(folder / "rig.yaml");
    const Evidence evidence(rig, read_all(find_recordings(folder)));
    const Diagnosis diagnosis = diagnose(evidence);
    ASSERT_THAT(diagnosis.effects, SizeIs(2));
    EXPECT_EQ(diagnosis.effects[0].effect, "coulomb_friction");
    EXPECT_EQ(diagnosis.effects[1].effect, "friction_asymmetry");
    // Published: 20.4 N at 35.15 N/V; 167 and 240 N s/m where the file says 203.5.
    EXPECT_NEAR(diagnosis.effects[0].parameters[0].value, 20.4 / 35.15, 0.03);
    EXPECT_NEAR(diagnosis.effects[1].parameters[0].value, (167.0 - 203.5) / 35.15e3, 3e-4);
    EXPECT_NEAR(diagnosis.effects[1].parameters[1].value, (240.0 - 203.5) / 35.15e3, 3e-4);
    ASSERT_TRUE(diagnosis.unexplained);
    EXPECT_THAT(diagnosis.unexplained->depends_on, Contains("position, periodic (2.5 mm)"));

    const double mm = rig.macro.encoder_resolution_mm;
    const SignalGap& encoder = diagnosis.signals.front();
    EXPECT_LT(encoder.after * mm, 1.6);
    const double before = relative_force_error(evidence, {}),
                 after = relative_force_error(evidence, diagnosis.hypothesis);
    EXPECT_GT(before, 0.15);
    EXPECT_LT(after, 0.06);
    std::printf("held-out windows of 1 s: %.3g -> %.3g mm; force: %.3g -> %.3g of the motor's\n",
                encoder.before * mm, encoder.after * mm, before, after);
}

}  // namespace

}  // namespace fidservo
