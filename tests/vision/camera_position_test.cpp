// SPDX-License-Identifier: GPL-3.0-or-later
// The machine's own frames, rendered by the simulated plate, through the real detector.
#include "vision/camera_position.h"

#include "core/camera/camera_parameters.h"
#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "plant/view/plate_view.h"
#include "tests/row_of_tags.h"
#include "vision/tags/tag_choice.h"
#include "vision/tags/tag_detector.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

using ::testing::HasSubstr;

CameraParameters reference_camera() {
    return {{1280, 960, 5000.0, {639.5, 479.5}, 20.0}, 50.0, 0.002, 10000.0, 5.0, 0.8, 0.03, 0.02, 20.0};
}

Frame take(const Plate& plate, double s_mm, std::uint64_t number, const plant::ViewOptions& options = {}) {
    const plant::PlateView view(reference_camera(), plate, options);
    return {view.render(std::array<double, 1>{s_mm}, number), static_cast<TimeNs>(number), 0, number, ""};
}

Result<PositionFit> locate(const Frame& frame, int expected, const Plate& nominal = row_of_tags()) {
    TagDetector detector;
    return locate_camera(reference_camera().geometry, nominal, frame,
                         detector.detect(frame.image, frame.time_ns), expected);
}

Reason reason_of(const Result<PositionFit>& result) {
    EXPECT_FALSE(result);
    return result ? Reason::stopped : result.error().reason;
}

/// Turned by 1 degree, tilted by 3, distorting, on an axis that is 0.5 mrad oblique.
CameraGeometry camera_as_it_comes() {
    constexpr double degree = std::numbers::pi / 180;
    CameraGeometry camera = reference_camera().geometry;
    camera.focal_ratio = 1.003;
    camera.distortion = {.k1 = -0.2, .k2 = 0.05, .p1 = 0.001, .p2 = -0.0005};
    camera.rotation_rad = 1.0 * degree;
    camera.tilt_rad = {2.0 * degree, -2.236 * degree};
    camera.axis_rad = {0.0005, -0.0003};
    return camera;
}

/// The exact image of a tag that is rotated by phi, rad, about its centre, from the camera position (s, y).
RefinedTag exact_picture(const CameraGeometry& camera, const PlateTag& tag, const Eigen::Vector2d& camera_mm,
                         double phi) {
    const PlateTag moved{tag.id, tag.centre_mm - Eigen::Vector2d(0.0, camera_mm.y()), tag.side_mm,
                         tag.angle_rad + phi};
    RefinedTag seen{};
    seen.covariance_px2.setIdentity();
    seen.centre_covariance_px2.setIdentity();
    seen.centre_px = project(camera, moved.centre_mm, camera_mm.x());
    for (std::size_t k = 0; k < 4; ++k)
        seen.detection.corners_px[k] = project(camera, corners_mm(moved)[k], camera_mm.x());
    return seen;
}

TEST(CameraPosition, ExactPicture_GivesExactPositionAndRotation) {
    for (const CameraGeometry& camera : {reference_camera().geometry, camera_as_it_comes()})
        for (const double phi : {0.0, 0.02, -0.5, 3.0})
            for (const double s_mm : {8.7, 6.9}) {
                const PlateTag tag{4, {8.0, 0.3}, 1.2, 0.1};
                const PositionFit fit =
                    fit_position(camera, tag, exact_picture(camera, tag, {s_mm, -0.1}, phi));
                EXPECT_NEAR(fit.position.s_mm, s_mm, 1e-9);
                EXPECT_NEAR(fit.position.y_mm, -0.1, 1e-9);
                EXPECT_NEAR(fit.rotation_rad, phi, 1e-9);
                EXPECT_LT(fit.residual_rms_px, 1e-9);
            }
}

TEST(CameraPosition, CameraAsItComes_DriftsAsideAlongTheTravel) {
    // The oblique axis is part of the camera: y stays what it is at the far end of the travel.
    const CameraGeometry camera = camera_as_it_comes();
    const PlateTag tag{4, {180.0, 0.0}, 1.2};
    const PositionFit fit = fit_position(camera, tag, exact_picture(camera, tag, {180.3, 0.02}, 0.0));
    EXPECT_NEAR(fit.position.s_mm, 180.3, 1e-6);
    EXPECT_NEAR(fit.position.y_mm, 0.02, 1e-6);
}

TEST(CameraPosition, ExactCornersAlone_GiveTheExactPosition) {
    const CameraGeometry camera = camera_as_it_comes();
    const PlateTag tag{4, {8.0, 0.3}, 1.2};
    const PositionFit fit =
        fit_position(camera, tag, unrefined(exact_picture(camera, tag, {8.9, 0.0}, 0.0).detection));
    EXPECT_NEAR(fit.position.s_mm, 8.9, 1e-6);
    EXPECT_NEAR(fit.position.y_mm, 0.0, 1e-6);
}

TEST(CameraPosition, ClaimedDeviations_AreTheScatterOfNoisyCentresAndCorners) {
    constexpr std::uint64_t seed = 17;
    NoiseStream random(seed, "noisy_centres");
    constexpr double centre_std_px = 0.01, corner_std_px = 0.03;
    for (const CameraGeometry& camera : {reference_camera().geometry, camera_as_it_comes()}) {
        const PlateTag tag{4, {8.0, 0.3}, 1.2};
        Eigen::Array3d squares = Eigen::Array3d::Zero(), claimed;
        constexpr int draws = 4000;
        for (int k = 0; k < draws; ++k) {
            RefinedTag seen = exact_picture(camera, tag, {8.9, 0.1}, 0.0);
            const auto noise = [&](double std_px) -> Eigen::Vector2d {
                return std_px * Eigen::Vector2d(random.normal(), random.normal());
            };
            seen.centre_px += noise(centre_std_px);
            for (Eigen::Vector2d& corner : seen.detection.corners_px) corner += noise(corner_std_px);
            seen.centre_covariance_px2 *= centre_std_px * centre_std_px;
            seen.covariance_px2 *= corner_std_px * corner_std_px;
            const PositionFit fit = fit_position(camera, tag, seen);
            squares +=
                Eigen::Array3d(fit.position.s_mm - 8.9, fit.position.y_mm - 0.1, fit.rotation_rad).square() /
                draws;
            claimed = {fit.position.s_std_mm, fit.y_std_mm, fit.rotation_std_rad};
        }
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(std::sqrt(squares(k)) / claimed(k), 1.0, 0.04) << "seed " << seed;
    }
}

TEST(CameraPosition, MovingStage_TellsTheRefinementHowThePictureMoves) {
    const PlateTag tag{4, {8.0, 0.0}, 1.2};
    const CameraGeometry camera = reference_camera().geometry;
    const TagDetection found = exact_picture(camera, tag, {8.3, 0.0}, 0.0).detection;
    const RefinementOptions options = refinement_of(camera, tag, found, {.moved_mm = 0.02});
    EXPECT_LT((options.motion_px - Eigen::Vector2d(-5.0, 0.0)).norm(), 1e-9);
    ASSERT_TRUE(options.camera);
    CameraGeometry turned = camera;
    turned.rotation_rad = std::numbers::pi / 2;
    EXPECT_LT(
        (refinement_of(turned, tag, exact_picture(turned, tag, {8.3, 0.0}, 0.0).detection, {.moved_mm = 0.02})
             .motion_px -
         Eigen::Vector2d(0.0, -5.0))
            .norm(),
        1e-9);
}

TEST(SlowCameraPosition, RenderedFrames_AreLocatedAsWellAsClaimed) {
    const Plate plate = row_of_tags();
    plant::ViewOptions even;
    even.light.gradient = {0.0, 0.0};
    even.light.vignetting = 0.0;
    const plant::PlateView view(reference_camera(), plate, even);
    NoiseStream random(11, "places");
    TagDetector detector;
    double squares = 0.0;
    double normalised = 0.0;
    double sum = 0.0;
    constexpr int frames = 40;
    for (int k = 0; k < frames; ++k) {
        const double s = 20.0 + 100.0 * random.uniform();
        const Frame frame{view.render(std::array<double, 1>{s}, k), k, 0, 0, ""};
        const int expected = tag_to_use(reference_camera().geometry, plate, s)->id;
        const auto found = detector.detect(frame.image, frame.time_ns);
        const auto fit = locate_camera(reference_camera().geometry, plate, frame, found, expected);
        ASSERT_TRUE(fit) << fit.error().text << " seed 11, frame " << k;
        EXPECT_EQ(fit->position.time_ns, k);
        EXPECT_EQ(fit->position.tag_id, expected);
        const double error = fit->position.s_mm - s;
        sum += error / frames;
        squares += error * error / frames;
        normalised += std::pow(error / fit->position.s_std_mm, 2) / frames;
    }
    RecordProperty("rms_um", std::to_string(1000 * std::sqrt(squares)));
    EXPECT_LT(1000 * std::sqrt(squares), 0.02);
    EXPECT_LT(1000 * std::abs(sum), 0.01);
    EXPECT_GT(std::sqrt(normalised), 0.6);
    EXPECT_LT(std::sqrt(normalised), 1.5);
}

TEST(CameraPosition, EmptyPlate_HasNoTag) {
    const auto result = locate(take({}, 10.0, 1), 5);
    EXPECT_EQ(reason_of(result), Reason::no_tag);
}

TEST(CameraPosition, AnotherTagInItsPlace_IsWrong) {
    Plate swapped = row_of_tags();
    for (PlateTag& tag : swapped.tags) tag.id = tag.id + 100;
    const auto result = locate(take(swapped, 10.0, 1), 5);
    EXPECT_EQ(reason_of(result), Reason::wrong_tag);
    EXPECT_THAT(result.error().text, HasSubstr("105 (not on the plate)"));
    EXPECT_EQ(reason_of(locate(take(row_of_tags(), 10.0, 1), 300)), Reason::wrong_tag);
}

TEST(CameraPosition, SameTagTwice_IsSeveral) {
    Plate twins = row_of_tags();
    twins.tags[6].id = 5;
    EXPECT_EQ(reason_of(locate(take(twins, 11.0, 1), 5)), Reason::several_tags);
}

plant::ViewOptions with_chip(const Eigen::Vector2d& centre_mm, const Eigen::Vector2d& size_mm) {
    plant::ViewOptions options;
    options.occluders.push_back({"chip", Pad{centre_mm, size_mm}, 0.9});
    return options;
}

TEST(CameraPosition, ChipOverTheBorder_IsOccluded) {
    const Eigen::Vector2d on_the_right_edge(10.6, 0.2);
    for (const double size_mm : {0.2, 0.5}) {
        const Frame beside_another =
            take(row_of_tags(), 10.3, 1, with_chip(on_the_right_edge, {size_mm, size_mm}));
        EXPECT_EQ(reason_of(locate(beside_another, 5)), Reason::occluded)
            << "told by tag 6, chip " << size_mm;

        const Frame alone = take(row_of_tags(), 10.0, 1, with_chip(on_the_right_edge, {size_mm, size_mm}));
        TagDetector detector;
        LocateOptions options;
        options.predicted_s_mm = 10.04;
        const auto result = locate_camera(reference_camera().geometry, row_of_tags(), alone,
                                          detector.detect(alone.image, 1), 5, options);
        EXPECT_EQ(reason_of(result), Reason::occluded) << "told by the stage, chip " << size_mm;
    }
}

TEST(CameraPosition, TagMissingFromThePlate_IsWrongNotOccluded) {
    Plate gap = row_of_tags();
    gap.tags.erase(gap.tags.begin() + 5);
    EXPECT_EQ(reason_of(locate(take(gap, 10.3, 1), 5)), Reason::wrong_tag);
}

TEST(CameraPosition, DustInsideTheTag_DoesNoHarm) {
    const auto fit = locate(take(row_of_tags(), 10.3, 1, with_chip({10.05, 0.07}, {0.1, 0.1})), 5);
    ASSERT_TRUE(fit) << fit.error().text;
    EXPECT_NEAR(fit->position.s_mm, 10.3, 1e-4);
}

TEST(CameraPosition, LampOnTheTag_IsGlare) {
    plant::ViewOptions options;
    options.glare.push_back({{10.3, 0.1}, 0.3, 3.0});
    EXPECT_EQ(reason_of(locate(take(row_of_tags(), 10.0, 1, options), 5)), Reason::glare);
    options.glare[0].radius_mm = 1.0;  // nothing can be read any more
    EXPECT_EQ(reason_of(locate(take(row_of_tags(), 10.0, 1, options), 5)), Reason::glare);
}

}  // namespace
}  // namespace fidservo::vision
