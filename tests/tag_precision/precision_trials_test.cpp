// SPDX-License-Identifier: GPL-3.0-or-later
// The judge itself is judged: by estimators whose errors are known.
#include "tests/tag_precision/precision_trials.h"

#include "tests/tag_precision/cramer_rao.h"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace fidservo::precision {
namespace {

PrecisionCase small_case() {
    PrecisionCase it = precision_cases().front();
    it.scene.camera.width_px = it.scene.camera.height_px = 100;
    it.scene.camera.principal_point_px = {49.5, 49.5};
    it.scene.centre_px = {49.5, 49.5};
    it.scene.side_px = 60.0;
    it.known.camera = it.scene.camera;
    return it;
}

/// One step of weighted least squares from the truth, with every nuisance unknown: an estimator that attains
/// the bound if frames have the noise that the bound assumes.
TEST(SlowPrecisionTrials, LeastSquaresFromTheTruth_AttainTheBound) {
    const PrecisionCase of = small_case();
    int known_shift = -1;
    std::vector<cv::Mat1d> slopes;
    cv::Mat1d mean;
    Eigen::MatrixXd covariance;
    const Estimator oracle = [&](const Trial& trial) {
        if (trial.shift != known_shift) {
            known_shift = trial.shift;
            TagScene scene = of.scene;
            scene.centre_px = trial.truth_px;
            slopes = sensitivities(scene, of.sensor);
            mean = mean_picture(scene);
            const Eigen::MatrixXd fisher = fisher_information(scene, of.sensor);
            covariance = fisher.ldlt().solve(Eigen::MatrixXd::Identity(fisher.rows(), fisher.cols()));
        }
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(covariance.rows());
        for (int v = 0; v < mean.rows; ++v)
            for (int u = 0; u < mean.cols; ++u) {
                const double share = mean(v, u);
                const double rest =
                    (trial.frame(v, u) - grey_of(of.sensor, share)) / grey_variance(of.sensor, share);
                for (Eigen::Index k = 0; k < gradient.size(); ++k)
                    gradient[k] += rest * slopes[static_cast<std::size_t>(k)](v, u);
            }
        const Eigen::Vector2d step = (covariance * gradient).head<2>();
        return Estimate{trial.truth_px + step, covariance.topLeftCorner<2, 2>()};
    };
    const PrecisionFigures figures = judge(of, {.shifts = 15, .draws = 100, .seed = 3}, oracle);
    for (const AxisFigures& axis : {figures.u, figures.v}) {
        EXPECT_LT(axis.sigma_lower_px, axis.bound_px);
        EXPECT_GT(axis.sigma_upper_px, axis.bound_px);
        EXPECT_LT(std::abs(axis.bias_px), 1.5 * axis.bias_error_px);
    }
    EXPECT_GT(figures.nees, figures.nees_low);
    EXPECT_LT(figures.nees, figures.nees_high);
    EXPECT_THAT(reproaches(figures, of.limits, true), ::testing::IsEmpty());
}

/// The statistics show errors of known size, and these are reported as too large.
TEST(PrecisionTrials, ErrorsMadeOnPurpose_AreFound) {
    const PrecisionCase of = small_case();
    NoiseStream noise(4, "errors");
    constexpr double bias_px = 0.004, harmonic_px = 0.002, sigma_px = 0.003;
    int asked = 0;
    const Estimator wrong = [&](const Trial& trial) -> std::optional<Estimate> {
        if (++asked % 100 == 0) return std::nullopt;
        if (asked % 100 == 1) return Estimate{trial.truth_px + Eigen::Vector2d(2.0, 0.0), std::nullopt};
        const double periodic = harmonic_px * std::sin(2.0 * std::numbers::pi * trial.truth_px.x() + 0.7);
        const double u = bias_px + periodic + sigma_px * noise.normal();
        return Estimate{trial.truth_px + Eigen::Vector2d(u, sigma_px * noise.normal()),
                        Eigen::Matrix2d(0.25 * sigma_px * sigma_px * Eigen::Matrix2d::Identity())};
    };
    const PrecisionFigures figures = judge(of, {.shifts = 100, .draws = 20, .seed = 5}, wrong);
    EXPECT_EQ(figures.trials, 2000);
    EXPECT_EQ(figures.failed, 40);
    const double error = sigma_px / std::sqrt(2000.0);
    EXPECT_NEAR(figures.u.bias_px, bias_px, 4 * error);
    EXPECT_NEAR(figures.v.bias_px, 0.0, 4 * error);
    EXPECT_NEAR(figures.v.bias_error_px, 1.96 * error, 0.5 * error);
    EXPECT_NEAR(figures.u.first_harmonic_px, harmonic_px, 4 * std::numbers::sqrt2 * error);
    EXPECT_LT(figures.v.first_harmonic_px, 4 * std::numbers::sqrt2 * error);
    EXPECT_NEAR(figures.v.sigma_px, sigma_px, 4 * sigma_px / std::sqrt(4000.0));
    EXPECT_LT(figures.v.sigma_lower_px, sigma_px);
    EXPECT_GT(figures.v.sigma_upper_px, sigma_px);
    EXPECT_GT(figures.nees, 4.0);
    EXPECT_NEAR(figures.nees_low, 1.0 - 2.576 / std::sqrt(1960.0), 0.005);
    EXPECT_NEAR(figures.nees_high, 1.0 + 2.576 / std::sqrt(1960.0), 0.005);
    using ::testing::Contains;
    using ::testing::HasSubstr;
    const auto found = reproaches(figures, of.limits, true);
    for (const char* what : {"failed", "sigma_u", "bias_u", "first harmonic_u", "NEES"})
        EXPECT_THAT(found, Contains(HasSubstr(what)));
    EXPECT_THAT(found, ::testing::Not(Contains(HasSubstr("bias_v"))));
}

TEST(PrecisionTrials, SamePlan_GivesTheSameFrames) {
    const PrecisionCase of = small_case();
    const auto all = [&](std::uint64_t seed) {
        cv::Mat1b frames;
        for_each_trial(of, {.shifts = 2, .draws = 2, .seed = seed},
                       [&](const Trial& trial) { frames.push_back(trial.frame); });
        return frames;
    };
    EXPECT_EQ(cv::norm(all(1), all(1), cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(all(1), all(2), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace fidservo::precision
