// SPDX-License-Identifier: GPL-3.0-or-later
// End to end: a rig that differs from its file, moved by a session that knows the file only, with rendered
// images.
#include "core/result.h"
#include "core/rig.h"
#include "src/calibrate/stage_verdict.h"
#include "tests/session/watched_rig.h"

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;

struct Surveyed {
    std::vector<StageShot> shots;
    StageNumbers numbers;
    double rig_time_s;
};

Result<Surveyed> survey(const plant::PlantParameters& physics, const StagePlan& plan, std::uint64_t seed) {
    WatchedRig rig(physics, reference_plate(), seed);
    if (auto homed = rig.session.home(); !homed) return tl::make_unexpected(homed.error());
    auto shots = StageSurvey(rig.session.pilot(), plan).run([] {});
    if (!shots) return tl::make_unexpected(shots.error());
    Surveyed surveyed{std::move(*shots), {}, rig.session.now_s()};
    auto numbers = stage_numbers(rig.file, surveyed.shots);
    if (!numbers) return tl::make_unexpected(numbers.error());
    surveyed.numbers = std::move(*numbers);
    return surveyed;
}

std::set<std::string> drifts_of(const plant::PlantParameters& physics, std::uint64_t seed) {
    const auto surveyed = survey(physics, quick_plan, seed);
    if (!surveyed) return {"failed: " + surveyed.error().text};
    EXPECT_LT(surveyed->rig_time_s, 60.0);
    const Rig believed = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    std::set<std::string> drifted;
    for (const auto& verdict : calib::judge_drift(expectations(believed, surveyed->numbers)))
        if (verdict.drifted) drifted.insert(verdict.of.quantity);
    return drifted;
}

TEST(SlowStageCalibration, CameraOtherThanItsFile_IsFoundToATenThousandth) {
    plant::PlantParameters physics = reference_physics();
    physics.camera->pixel_scale = 1.004;
    physics.camera->rotation_rad = 0.8 * rad_per_deg;
    physics.camera->tilt_rad = {0.4 * rad_per_deg, -0.3 * rad_per_deg};
    physics.camera->distortion = -0.25;
    physics.encoder.resolution_mm *= 1.003;
    physics.micro->hall.span_V *= 1.02;
    const auto surveyed = survey(physics, StagePlan{}, 3);
    ASSERT_TRUE(surveyed) << surveyed.error().text;
    const StageNumbers& numbers = surveyed->numbers;
    const calib::StageMap& map = numbers.map;
    EXPECT_NEAR(map.scale_px_per_mm() / (250.0 * 1.004), 1.0, 1e-4);
    EXPECT_NEAR(map.camera.rotation_rad, 0.8 * rad_per_deg, 1e-4);
    EXPECT_NEAR(map.camera.axis_rad.x(), 0.0, 1e-4);
    EXPECT_NEAR(map.camera.axis_rad.y(), 0.0, 1e-4);
    EXPECT_NEAR(map.camera.tilt_rad.x(), 0.4 * rad_per_deg, 2e-3);
    EXPECT_NEAR(map.camera.tilt_rad.y(), -0.3 * rad_per_deg, 2e-3);
    // The map keeps the file's focal length, which is too small by a factor of 1.004, so that normalised
    // image radii are larger by it and k1 is smaller by its square.
    EXPECT_NEAR(map.camera.distortion.k1, -0.25 / (1.004 * 1.004), 0.001);
    EXPECT_NEAR(numbers.encoder.resolution_mm / (0.05 * 1.003), 1.0, 1e-4);
    EXPECT_NEAR(numbers.hall.hall.span_V / (1.25 * 1.02), 1.0, 1e-3);
    std::printf(
        "scale %.3g +- %.2g, rotation %.3g +- %.2g rad, axis %.3g %.3g rad, k1 %.4f +- %.4f, encoder %.3g "
        "+- %.2g, Hall span %.3g +- %.2g, misfit %.3f, platform %.3g um\n",
        map.scale_px_per_mm() / 251.0 - 1.0, map.relative_scale_std(),
        map.camera.rotation_rad - 0.8 * rad_per_deg, map.std(calib::map_rotation), map.camera.axis_rad.x(),
        map.camera.axis_rad.y(), map.camera.distortion.k1, map.std(calib::map_k1),
        numbers.encoder.resolution_mm / 0.05015 - 1.0, numbers.encoder.resolution_std_mm / 0.05,
        numbers.hall.hall.span_V / 1.275 - 1.0, numbers.hall.span_std_V / 1.275, map.misfit,
        1e3 * numbers.platform_error_mm);
    for (const FreshTest& test : test_fresh(numbers, surveyed->shots))
        EXPECT_TRUE(test.passed) << test.what << ": " << test.rms << " of " << test.promised_rms << " "
                                 << test.unit << ", worst " << test.worst << " of " << test.allowed_worst;
}

TEST(SlowStageCalibration, RigThatIsAsItsFileSays_IsHealthy) {
    for (const std::uint64_t seed : {1, 2, 3})
        EXPECT_THAT(drifts_of(reference_physics(), seed), ::testing::IsEmpty()) << "seed " << seed;
}

TEST(SlowStageCalibration, Drifts_AreNamedThroughTheCamera) {
    plant::PlantParameters scale = reference_physics();
    scale.camera->pixel_scale = 1.0005;
    EXPECT_THAT(drifts_of(scale, 4), ::testing::ElementsAre("camera scale"));
    plant::PlantParameters rotation = reference_physics();
    rotation.camera->rotation_rad = 0.1 * rad_per_deg;
    EXPECT_THAT(drifts_of(rotation, 5), ::testing::ElementsAre("camera rotation"));
    plant::PlantParameters hall = reference_physics();
    hall.micro->hall.span_V *= 1.01;
    EXPECT_THAT(drifts_of(hall, 6), ::testing::ElementsAre("Hall gain"));
    plant::PlantParameters all = scale;
    all.camera->rotation_rad = 0.1 * rad_per_deg;
    all.micro->hall.span_V *= 0.99;
    EXPECT_THAT(drifts_of(all, 7), ::testing::ElementsAre("Hall gain", "camera rotation", "camera scale"));
}

}  // namespace
}  // namespace fidservo
