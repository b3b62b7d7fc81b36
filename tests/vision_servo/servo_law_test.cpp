// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/servo/servo_law.h"

#include <cmath>
#include <numbers>
#include <random>

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
    for (std::size_t k = 0; k < 4; ++k)
        seen.corners_px[k] = project(parameters.camera, seen.plate_corners_mm[k], s_mm);
    seen.corner_covariance_px2 = Eigen::Matrix<double, 8, 8>::Identity() * 1e-4;
    return seen;
}

ServoParameters turned(double rotation_rad) {
    ServoParameters parameters{camera};
    parameters.camera.rotation_rad = rotation_rad;
    return parameters;
}

ServoParameters tilted(const Eigen::Vector2d& tilt_rad) {
    ServoParameters parameters{camera};
    parameters.camera.tilt_rad = tilt_rad;
    return parameters;
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
        const ServoParameters parameters = turned(angle * degree);
        const ServoMove move = servo_law(parameters, observe(parameters, 10.0, 9.2), 10.15);
        EXPECT_NEAR(move.move_mm, 0.95, 1e-9) << angle;
    }
}

TEST(ServoLaw, TurnedCameraTakenForStraight_LosesTheCosine) {
    const double angle = 5.0 * degree;
    const ServoObservation seen = observe(turned(angle), 10.0, 9.0);
    const ServoMove move = servo_law({camera}, seen, 10.0);
    EXPECT_NEAR(move.move_mm, std::cos(angle), 1e-9);
    EXPECT_GT(move.residual_px, 10.0);
}

TEST(ServoLaw, TiltedCamera_ConvergesInAFewSteps) {
    const ServoParameters parameters = tilted({0.0, 2.0 * degree});
    double s = 9.0;
    for (int step = 0; step < 5; ++step)
        s += servo_law(parameters, observe(parameters, 10.0, s), 10.2).move_mm;
    EXPECT_NEAR(s, 10.2, 1e-9);
}

/// Turned by 1 degree, tilted by 3, distorting, on an oblique axis.
ServoParameters as_it_comes() {
    ServoParameters parameters{camera};
    parameters.camera.focal_ratio = 1.003;
    parameters.camera.distortion = {.k1 = -0.2, .k2 = 0.05, .p1 = 0.001, .p2 = -0.0005};
    parameters.camera.rotation_rad = 1.0 * degree;
    parameters.camera.tilt_rad = {2.0 * degree, -2.236 * degree};
    parameters.camera.axis_rad = {0.0005, -0.0003};
    return parameters;
}

TEST(ServoLaw, CameraAsItComes_ConvergesToTheTargetItself) {
    const ServoParameters parameters = as_it_comes();
    for (const double start : {9.0, 9.9, 11.3}) {
        double s = start;
        ServoMove move{};
        for (int step = 0; step < 4; ++step) {
            move = servo_law(parameters, observe(parameters, 10.0, s), 10.15);
            s += move.move_mm;
        }
        EXPECT_NEAR(s, 10.15, 1e-9) << "from " << start;
        EXPECT_LT(move.residual_px, 1e-6);
    }
}

TEST(ServoLaw, CameraAsItComes_FirstStepOfATenthMillimetreIsGoodToTenNanometres) {
    const ServoParameters parameters = as_it_comes();
    const ServoMove move = servo_law(parameters, observe(parameters, 10.0, 10.05), 10.15);
    EXPECT_NEAR(move.move_mm, 0.1, 1e-5);
}

TEST(ServoLaw, CameraAsItComesTakenForStraight_LeavesAResidual) {
    const ServoObservation seen = observe(as_it_comes(), 10.0, 10.1);
    EXPECT_GT(servo_law({camera}, seen, 10.0).residual_px, 5.0);
    EXPECT_LT(servo_law(as_it_comes(), seen, 10.0).residual_px, 0.05);
}

TEST(ServoLaw, CornerThatIsBadlySeen_HardlyCounts) {
    const ServoParameters parameters{camera};
    ServoObservation seen = observe(parameters, 10.0, 9.9);
    seen.corners_px[2].x() += 1.0;
    seen.corner_covariance_px2 *= 1e-2;
    const double even_mm = servo_law(parameters, seen, 10.0).move_mm;
    seen.corner_covariance_px2.block<2, 2>(4, 4) = Eigen::Matrix2d::Identity() * 25.0;
    const ServoMove weighed = servo_law(parameters, seen, 10.0);
    EXPECT_NEAR(even_mm, 0.1 + 0.25 * 0.004, 1e-6);  // a quarter of a pixel of 4 um
    // m is 0.31 px: the bad corner weighs m^2 / (5^2 + m^2) of each other one and pulls by 0.0012 px.
    EXPECT_NEAR(weighed.move_mm, 0.1 + 0.00124 * 0.004, 1e-7);
    EXPECT_NEAR(weighed.std_mm, 0.0062 * 0.004, 1e-6);
}

TEST(ServoLaw, CornersThatMoveTogether_AreNoWorseForIt) {
    // A calibrated camera's corners know shift, turn and scale only: a covariance of rank four.
    const ServoParameters parameters{camera};
    ServoObservation seen = observe(parameters, 10.0, 9.9);
    Eigen::Matrix<double, 8, 4> by_shift_turn_scale;
    for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d from_middle =
            seen.corners_px[k] - 0.5 * (seen.corners_px[0] + seen.corners_px[2]);
        by_shift_turn_scale.block<2, 4>(2 * k, 0) << 1, 0, -from_middle.y(), from_middle.x(), 0, 1,
            from_middle.x(), from_middle.y();
    }
    const Eigen::Vector4d variances(1e-6, 1e-6, 4e-10, 4e-10);
    seen.corner_covariance_px2 =
        by_shift_turn_scale * variances.asDiagonal() * by_shift_turn_scale.transpose();
    const ServoMove move = servo_law(parameters, seen, 10.0);
    EXPECT_NEAR(move.move_mm, 0.1, 1e-9);
    EXPECT_NEAR(move.std_mm, 1e-3 * 0.004, 1e-8);
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

void expect_honest_deviation(const ServoParameters& parameters) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise(0.0, 0.01);
    const double exact_mm = servo_law(parameters, observe(parameters, 10.0, 9.2), 10.15).move_mm;
    double squares = 0.0;
    double claimed = 0.0;
    constexpr int draws = 4000;
    for (int k = 0; k < draws; ++k) {
        ServoObservation seen = observe(parameters, 10.0, 9.2);
        for (Eigen::Vector2d& corner : seen.corners_px)
            corner += Eigen::Vector2d(noise(random), noise(random));
        const ServoMove move = servo_law(parameters, seen, 10.15);
        squares += (move.move_mm - exact_mm) * (move.move_mm - exact_mm) / draws;
        claimed = move.std_mm;
    }
    EXPECT_NEAR(std::sqrt(squares) / claimed, 1.0, 0.04);  // 4000 draws: 1.1 % of scatter
}

TEST(ServoLaw, ClaimedDeviation_IsTheScatterOfNoisyMoves) {
    expect_honest_deviation(turned(7.0 * degree));
    expect_honest_deviation(as_it_comes());
}

}  // namespace
}  // namespace fidservo::vision
