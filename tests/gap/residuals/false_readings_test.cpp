// SPDX-License-Identifier: GPL-3.0-or-later
// Tags that are displaced by a sensor's false readings, and by other causes.
#include "gap/residuals/false_readings.h"

#include "gap/evidence.h"
#include "tests/gap/simulated_campaign.h"

#include <initializer_list>
#include <optional>
#include <string_view>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;
using testing::effects;

std::optional<Signal> displacing(std::initializer_list<std::string_view> truth,
                                 std::initializer_list<std::string_view> runs = {
                                     "macro-pulses", "macro-square", "micro-steps"}) {
    const Evidence evidence = testing::campaign(effects(truth), runs);
    return sensor_that_displaces_tags(evidence, evidence.errors({}, everything(evidence)));
}

TEST(FalseReadings, SensorThatReadsFalsely_DisplacesTheTags) {
    EXPECT_EQ(displacing({"hall_nonlinearity:cubic_shift=0.05"}), Signal::hall);
    EXPECT_EQ(displacing({"hall_gain:factor=1.05"}), Signal::hall);
    EXPECT_EQ(displacing({"encoder_scale:factor=1.005"}), Signal::encoder);
    EXPECT_EQ(displacing({"encoder_ripple:amplitude_um=60,period_mm=8,phase_rad=1"}), Signal::encoder);
}

TEST(FalseReadings, SensorThatReadsFalsely_IsKnownBesideAStageThatIsDrivenOtherwise) {
    EXPECT_EQ(displacing({"hall_nonlinearity:cubic_shift=0.05", "viscous_friction:damping_V_s_per_mm=4e-6"}),
              Signal::hall);
    EXPECT_EQ(displacing({"hall_gain:factor=1.05", "viscous_friction:damping_V_s_per_mm=4e-4"}),
              Signal::hall);
    EXPECT_EQ(displacing({"encoder_scale:factor=1.005", "heater_gain:factor=1.05"}), Signal::encoder);
}

TEST(FalseReadings, StagesThatAreDrivenOtherwise_AndCameras_DisplaceNoneBySensors) {
    EXPECT_EQ(displacing({"viscous_friction:damping_V_s_per_mm=4e-4"}), std::nullopt);
    EXPECT_EQ(displacing({"coulomb_friction:level_V=0.2"}), std::nullopt);
    EXPECT_EQ(displacing({"heater_gain:factor=1.05"}), std::nullopt);
    EXPECT_EQ(displacing({"camera_latency", "viscous_friction:damping_V_s_per_mm=4e-4"}), std::nullopt);
    EXPECT_EQ(displacing({"camera_latency", "heater_gain:factor=1.05"}), std::nullopt);
    EXPECT_EQ(displacing({"pixel_scale"}), std::nullopt);
    EXPECT_EQ(displacing({}), std::nullopt);
}

TEST(FalseReadings, StagesAtRest_SayNothing) {
    EXPECT_EQ(displacing({"encoder_scale:factor=1.005", "hall_gain:factor=1.05"}, {"rest"}), std::nullopt);
}

}  // namespace
}  // namespace fidservo
