#include "vision/servo/servo_law.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace fidservo::vision {
namespace {

constexpr double degree = std::numbers::pi / 180;

const CameraGeometry camera{1280, 960, 5000.0, {639.5, 479.5}, 20.0};

std::array<Eigen::Vector2d, 4> plate_corners(double x_mm) {
    return {Eigen::Vector2d(x_mm - 0.6, 0.6), {x_mm + 0.6, 0.6}, {x_mm + 0.6, -0.6}, {x_mm - 0.6, -0.6}};
}

/// The tag at x as the camera sees it from s.
ServoObservation observe(const ServoParameters& parameters, double tag_x_mm, double s_mm) {
    ServoObservation seen;
    seen.plate_corners_mm = plate_corners(tag_x_mm);
    seen.corners_px = corners_seen_from(parameters, seen.plate_corners_mm, s_mm);
    seen.corner_covariance_px2 = Eigen::Matrix<double, 8, 8>::Identity() * 1e-4;
    return seen;
}

ServoParameters mounted(const Eigen::Matrix3d& rotation) {
    ServoParameters parameters{camera};
    parameters.platform_from_camera = rotation;
    return parameters;
}

TEST(ServoLaw, SeenCorners_FollowTheRigsProjection) {
    const auto seen = corners_seen_from({camera}, plate_corners(8.0), 8.5);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_LT((seen[k] - project(camera, plate_corners(8.0)[k], 8.5)).norm(), 1e-9);
}

TEST(ServoLaw, LookingStraightDown_OneStepIsTheClosedForm) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> offset(-2.0, 2.0);
    for (int k = 0; k < 100; ++k) {
        const double tag_x = 2.0 * (k % 90);
        const double s = tag_x + offset(random);
        const double target = tag_x + offset(random);
        const ServoMove move = servo_law({camera}, observe({camera}, tag_x, s), target);
        EXPECT_NEAR(move.move_mm, target - s, 1e-9);
        EXPECT_NEAR(move.residual_px, 0.0, 1e-9);
    }
}

TEST(ServoLaw, CameraTurnedAboutItsAxis_IsStillExact) {
    for (const double angle : {-8.0, 3.0, 90.0, 180.0}) {
        ServoParameters parameters =
            mounted(Eigen::AngleAxisd(angle * degree, Eigen::Vector3d::UnitZ()).toRotationMatrix());
        parameters.camera_on_platform_mm = {1.5, -0.7, 0.0};
        const ServoMove move = servo_law(parameters, observe(parameters, 10.0, 9.2), 10.15);
        EXPECT_NEAR(move.move_mm, 0.95, 1e-9) << angle;
    }
}

TEST(ServoLaw, TurnedCameraTakenForStraight_LosesTheCosine) {
    const double angle = 5.0 * degree;
    const ServoParameters turned =
        mounted(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    ServoObservation seen = observe(turned, 10.0, 9.0);
    const ServoMove move = servo_law({camera}, seen, 10.0);
    EXPECT_NEAR(move.move_mm, std::cos(angle), 1e-9);
    EXPECT_GT(move.residual_px, 10.0);
}

TEST(ServoLaw, TiltedCamera_ConvergesInAFewSteps) {
    const ServoParameters parameters =
        mounted(Eigen::AngleAxisd(2.0 * degree, Eigen::Vector3d::UnitY()).toRotationMatrix());
    double s = 9.0;
    for (int step = 0; step < 5; ++step)
        s += servo_law(parameters, observe(parameters, 10.0, s), 10.2).move_mm;
    EXPECT_NEAR(s, 10.2, 1e-9);
}

TEST(ServoLaw, HalfGain_MakesHalfTheWay) {
    ServoParameters parameters{camera};
    parameters.gain = 0.5;
    const ServoMove move = servo_law(parameters, observe(parameters, 4.0, 4.3), 4.1);
    EXPECT_NEAR(move.move_mm, -0.1, 1e-9);
    EXPECT_NEAR(move.residual_px, 0.0, 1e-9);
}

TEST(ServoLaw, IndependentCornerNoise_GivesHalfOfItInTheMove) {
    // The mean of four independent u coordinates, 0.01 px each, at 4 um per px.
    const ServoMove move = servo_law({camera}, observe({camera}, 4.0, 4.3), 4.1);
    EXPECT_NEAR(move.std_mm, 0.01 / 2 * 0.004, 1e-12);
}

TEST(ServoLaw, CommonCornerNoise_GoesFullyIntoTheMove) {
    ServoObservation seen = observe({camera}, 4.0, 4.3);
    seen.corner_covariance_px2.setZero();
    for (int a = 0; a < 8; a += 2)
        for (int b = 0; b < 8; b += 2) seen.corner_covariance_px2(a, b) = 1e-4;
    EXPECT_NEAR(servo_law({camera}, seen, 4.1).std_mm, 0.01 * 0.004, 1e-12);
}

TEST(ServoLaw, ClaimedDeviation_IsTheScatterOfNoisyMoves) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise(0.0, 0.01);
    const ServoParameters parameters =
        mounted(Eigen::AngleAxisd(7.0 * degree, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    double squares = 0.0;
    double claimed = 0.0;
    constexpr int draws = 4000;
    for (int k = 0; k < draws; ++k) {
        ServoObservation seen = observe(parameters, 10.0, 9.2);
        for (Eigen::Vector2d& corner : seen.corners_px)
            corner += Eigen::Vector2d(noise(random), noise(random));
        const ServoMove move = servo_law(parameters, seen, 10.15);
        squares += (move.move_mm - 0.95) * (move.move_mm - 0.95) / draws;
        claimed = move.std_mm;
    }
    EXPECT_NEAR(std::sqrt(squares) / claimed, 1.0, 0.04);  // 4000 draws: 1.1 % of scatter
}

}  // namespace
}  // namespace fidservo::vision
