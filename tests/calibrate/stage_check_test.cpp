// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "src/calibrate/stage_verdict.h"
#include "src/files/rig/rig_file.h"
#include "tests/calibrate/synthetic_survey.h"
#include "tests/effort.h"

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::ElementsAre;

constexpr double corner_std_px = 0.01;

Rig file() {
    return load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
}

/// The quantities that a health check reports as drifted on a true rig, if the file is that of the reference
/// rig.
std::set<std::string> drifts_of(const Rig& truth, std::uint64_t seed) {
    const Rig believed = file();
    std::vector<StageShot> shots = synthetic_survey(truth, seed, corner_std_px);
    const auto numbers = stage_numbers(believed, shots);
    if (!numbers) return {"failed: " + numbers.error().text};
    std::set<std::string> drifted;
    for (const calib::DriftVerdict& verdict : calib::judge_drift(expectations(believed, *numbers)))
        if (verdict.drifted) drifted.insert(verdict.of.quantity);
    return drifted;
}

constexpr double tenth_of_a_degree = 0.1 * std::numbers::pi / 180.0;

TEST(StageCheck, ScaleDriftOfHalfAPerMille_IsTheCamerasScale) {
    Rig truth = file();
    truth.camera->geometry.focal_px *= 1.0005;
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        EXPECT_THAT(drifts_of(truth, seed), ElementsAre("camera scale")) << "seed " << seed;
}

TEST(StageCheck, CameraTurnedByATenthOfADegree_IsTheCamerasRotation) {
    Rig truth = file();
    truth.camera->geometry.rotation_rad = tenth_of_a_degree;
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        EXPECT_THAT(drifts_of(truth, seed), ElementsAre("camera rotation")) << "seed " << seed;
}

TEST(StageCheck, PlateLaidDownTurned_IsNotTheCamerasRotation) {
    // Camera and axis keep their angle to each other: both turn against the plate.
    Rig truth = file();
    truth.camera->geometry.rotation_rad = -tenth_of_a_degree;
    truth.camera->geometry.axis_rad.x() = std::tan(tenth_of_a_degree);
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        EXPECT_THAT(drifts_of(truth, seed), ElementsAre("stage axis in the plate")) << "seed " << seed;
}

TEST(StageCheck, HallGainOfOnePerCent_IsTheHallSensorsGain) {
    Rig truth = file();
    truth.micro->hall.span_V *= 1.01;
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        EXPECT_THAT(drifts_of(truth, seed), ElementsAre("Hall gain")) << "seed " << seed;
}

TEST(StageCheck, EncoderScaleOfOnePerMille_IsTheEncodersScale) {
    Rig truth = file();
    truth.macro.encoder_resolution_mm *= 1.001;
    EXPECT_THAT(drifts_of(truth, 3), ElementsAre("encoder scale"));
}

TEST(StageCheck, SeveralDrifts_AreAllNamed) {
    Rig truth = file();
    truth.camera->geometry.focal_px *= 0.9995;
    truth.camera->geometry.rotation_rad = -tenth_of_a_degree;
    truth.micro->hall.span_V *= 0.99;
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        EXPECT_THAT(drifts_of(truth, seed), ElementsAre("Hall gain", "camera rotation", "camera scale"))
            << "seed " << seed;
}

TEST(StageCheck, LensThatDistorts_IsTheLens) {
    Rig truth = file();
    truth.camera->geometry.distortion.k1 = -0.1;
    EXPECT_THAT(drifts_of(truth, 2), ElementsAre("lens distortion k1"));
}

/// Test of a calibrated rig's encoder on fresh stands whose positions are `from_middle` counts from the
/// middle of their count.
FreshTest fresh_encoder_test(double from_middle, double counts_lost) {
    const Rig rig = file();
    std::vector<StageShot> shots = synthetic_survey(rig, 11, corner_std_px);
    const auto numbers = stage_numbers(rig, shots);
    EXPECT_TRUE(numbers);
    SyntheticStands stands(rig, 12, corner_std_px);
    std::vector<StageShot> fresh;
    for (int i = 0; i < 8; ++i) {
        const double count = 100.0 + 450.0 * i, side = i % 3 == 0 ? -1.0 : 1.0;
        const double carriage_mm = rig.macro.encoder_resolution_mm * (count + side * from_middle);
        fresh.push_back(stands.at(StageMove::fresh_travel, carriage_mm, 2.0));
        fresh.back().count += counts_lost;
    }
    return test_fresh(*numbers, fresh).back();
}

TEST(FreshMoves, CarriageAtTheEdgesOfItsCounts_KeepsWhatIsPromised) {
    const FreshTest test = fresh_encoder_test(0.49, 0.0);
    EXPECT_EQ(test.errors, 8U);
    EXPECT_GT(test.rms, 23.0);
    EXPECT_TRUE(test.passed) << test.worst << " of " << test.allowed_worst << " um";
}

TEST(FreshMoves, EncoderThatLostACount_DoesNot) {
    EXPECT_FALSE(fresh_encoder_test(0.1, 1.0).passed);
}

TEST(SlowStageCheck, HealthyRigOverManySeeds_RaisesOneFalseAlarmInAHundredAtMost) {
    const int seeds = fidservo::testing::draws(200, 50);
    int alarms = 0;
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
        const auto drifted = drifts_of(file(), seed);
        alarms += drifted.empty() ? 0 : 1;
        for (const std::string& quantity : drifted)
            std::printf("seed %d: %s\n", static_cast<int>(seed), quantity.c_str());
    }
    // 1 % of 200 is 2; more than 6 would have a probability of 0.5 %, more than 3 of 50 one of 0.2 %.
    EXPECT_LE(alarms, seeds == 200 ? 6 : 3);
}

}  // namespace
}  // namespace fidservo
