// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Maximum likelihood of the macro stage's parameters by simulation: the model runs through each window under
// the recorded commands from a state of its own, and is judged by the counts it should have shown.
//
// Nothing is differentiated and no reading is fed back, so neither rounding nor a closed loop biases the fit,
// as both do a regression of accelerations on recorded velocities. Windows keep what the model does not know
// from adding up, as it would without bound behind an integrator.
#include "calib/batch_variance.h"
#include "calib/macro/macro_motion.h"
#include "calib/macro/macro_trace.h"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// Where the parameters of MacroMotion that a fit may change stand in all vectors here.
namespace macro_index {
inline constexpr int speed = 0, slope = 1, friction = 2, offset = 3, log_time_constant = 4;
}
inline constexpr int macro_parameter_count = 5;
using MacroActive = std::array<bool, macro_parameter_count>;
using MacroVector = Eigen::Matrix<double, macro_parameter_count, 1>;
using MacroMatrix = Eigen::Matrix<double, macro_parameter_count, macro_parameter_count>;

MacroVector vector_of(const MacroMotion& motion);
/// `motion` with the fitted parameters replaced; friction at least 0.
MacroMotion with_parameters(MacroMotion motion, const MacroVector& parameters);

/// A model and the state in which it enters each window.
struct MacroPoint {
    MacroMotion motion;
    std::vector<MacroMotionState> starts;
    double noise_count = 1.0;
};

/// What the standard errors of a fit are made of.
struct MacroInfluences {
    MacroMatrix inverse = MacroMatrix::Zero();  ///< inverse information; zero for parameters not fitted
    /// By recording, a column a block of 50 ms, longer where the reading stands still (the error of rounding
    /// stays the same while the reading does): by how much the block moved each parameter.
    std::vector<Eigen::Matrix<double, macro_parameter_count, Eigen::Dynamic>> blocks;
    std::size_t fitted = 0;  ///< number of active parameters
    double ticks = 0.0;      ///< readings
    double starts = 0.0;     ///< numbers fitted to them beside the parameters: two a window
};

/// Variance of a figure with this gradient by the parameters: of batches of blocks (calib/batch_variance.h),
/// at least what the likelihood claims. Each is larger by the share of the residual that what was fitted has
/// taken up: in short windows of few readings their starts take up much.
BatchVariance variance_along(const MacroInfluences& influences, const MacroVector& gradient);

class MacroEstimator {
  public:
    /// @param windows  not empty; what they show must outlive the estimator
    /// @param resolution_mm  of the encoder
    MacroEstimator(std::vector<MacroWindow> windows, double resolution_mm);

    /// The windows entered where they were recorded, at the velocity of their first ticks.
    MacroPoint start_at(const MacroMotion& motion) const;

    /// -log likelihood, with priors so wide (ten times what the data show) that they weigh nothing where the
    /// data speak; they only keep undetermined directions finite.
    double loss(const MacroPoint& point) const;

    /// Levenberg-Marquardt on the active parameters and all window starts.
    void refine(MacroPoint& point, const MacroActive& active, int most_iterations) const;

    /// Root mean square of prediction minus reading, counts.
    double residual_count(const MacroPoint& point) const;

    /// Standard deviation before rounding that explains the residual, at least a twentieth of a count.
    double noise_count(const MacroPoint& point) const;

    /// How the readings pull at the active parameters, and what the likelihood claims to know of them.
    MacroInfluences influences(const MacroPoint& point, const MacroActive& active) const;

    /// A window's prediction linearised: what lack-of-fit tests add columns to.
    struct Linearised {
        std::vector<double> prediction_count;
        Eigen::VectorXd slopes, curvatures;  ///< of -log likelihood by the predicted place, per count
        Eigen::MatrixXd own;     ///< derivative of the place by each parameter, the start having followed
        Eigen::MatrixXd starts;  ///< derivative by the start's position and velocity
        Eigen::Matrix2d start_information;
    };
    Linearised linearised(std::size_t window, const MacroPoint& point, const MacroActive& active) const;

    /// Prediction minus reading over a window.
    std::vector<double> errors_count(std::size_t window, const MacroPoint& point) const;

    /// Position and velocity of the model at each tick of a window.
    std::vector<MacroMotionState> course(std::size_t window, const MacroPoint& point) const;

    /// Precision of the priors, so that information from the data can be added to it.
    MacroMatrix prior_information() const { return prior_std_.cwiseAbs2().cwiseInverse().asDiagonal(); }

    const std::vector<MacroWindow>& windows() const { return windows_; }
    double fastest_mm_per_s() const { return fastest_mm_per_s_; }
    double resolution_mm() const { return resolution_mm_; }

  private:
    struct Terms;
    struct Sums;

    std::vector<double> predict(std::size_t window, const MacroMotion& motion,
                                const MacroMotionState& start) const;
    Eigen::MatrixXd sensitivities(std::size_t window, const MacroPoint& point,
                                  const MacroActive& active) const;
    Terms terms(std::size_t window, const MacroPoint& point, const MacroActive& active) const;
    Sums sum_up(const Terms& terms, std::size_t window, const MacroPoint& point) const;
    static Linearised linearised(Terms terms, const Sums& sums);
    double start_loss(std::size_t window, const MacroPoint& point) const;
    double start_std_mm(const MacroPoint& point) const;

    std::vector<MacroWindow> windows_;
    double resolution_mm_;
    double fastest_mm_per_s_ = 0.0;
    MacroVector prior_std_;
    MacroVector difference_;  ///< steps of the numerical derivatives
};

}  // namespace fidservo::calib
