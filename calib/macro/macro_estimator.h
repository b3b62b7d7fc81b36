// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Maximum likelihood of the macro stage's parameters by simulation: the model is simulated through each
// window under the recorded commands, from an initial state that is fitted too, and its counts are compared
// with the recorded ones.
//
// Readings are neither differentiated nor used as inputs, so that neither rounding nor a closed loop biases
// the fit; both bias a regression of accelerations on recorded velocities. Because of the windows, model
// errors do not accumulate without bound in the integrator.
#include "calib/batch_variance.h"
#include "calib/macro/macro_motion.h"
#include "calib/macro/macro_trace.h"

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// Indices of the parameters of MacroMotion in all vectors here.
namespace macro_index {
inline constexpr int speed = 0, slope = 1, friction = 2, offset = 3, log_time_constant = 4;
}
inline constexpr int macro_parameter_count = 5;
using MacroActive = std::array<bool, macro_parameter_count>;
using MacroVector = Eigen::Matrix<double, macro_parameter_count, 1>;
using MacroMatrix = Eigen::Matrix<double, macro_parameter_count, macro_parameter_count>;

MacroVector vector_of(const MacroMotion& motion);
/// `motion` with its parameters replaced; friction is at least 0.
MacroMotion with_parameters(MacroMotion motion, const MacroVector& parameters);

/// A model with its initial state in each window.
struct MacroPoint {
    MacroMotion motion;
    std::vector<MacroMotionState> starts;
    double noise_count = 1.0;
};

/// The contributions from which the standard errors of a fit are computed.
struct MacroInfluences {
    MacroMatrix inverse = MacroMatrix::Zero();  ///< inverse information; zero for parameters not fitted
    /// For each recording, a column for each block of 50 ms (longer where the reading stands still, since the
    /// rounding error stays the same while it does): the influence of the block on each parameter.
    std::vector<Eigen::Matrix<double, macro_parameter_count, Eigen::Dynamic>> blocks;
    std::size_t fitted = 0;  ///< number of active parameters
    double ticks = 0.0;      ///< number of readings
    double starts = 0.0;     ///< number of fitted initial values: two per window
};

/// Variance of a figure with this gradient by the parameters, from batches of blocks
/// (calib/batch_variance.h), but no less than by the likelihood. Both are corrected for the fraction of the
/// residuals that the fit has absorbed: in short windows with few readings the initial states absorb much.
BatchVariance variance_along(const MacroInfluences& influences, const MacroVector& gradient);

class MacroEstimator {
  public:
    /// @param windows  not empty; the data that they refer to must outlive the estimator
    /// @param resolution_mm  of the encoder
    MacroEstimator(std::vector<MacroWindow> windows, double resolution_mm);

    /// A point with this model. The initial state of each window is its first recorded position and the mean
    /// velocity of its first ticks.
    MacroPoint start_at(const MacroMotion& motion) const;

    /// Negative log likelihood, with priors so wide (ten times the range of the data) that they have no
    /// influence where the data determine a parameter; they only keep undetermined directions finite.
    double loss(const MacroPoint& point) const;

    /// Levenberg-Marquardt on the active parameters and all initial states.
    /// Ends early once the loss would stay above `wanted` even if the iterations that are left gained ten
    /// times what the last one did; Gauss-Newton steps near a minimum gain less each time.
    /// @return the loss of the point that was reached
    double refine(MacroPoint& point, const MacroActive& active, int most_iterations,
                  double wanted = std::numeric_limits<double>::infinity()) const;

    /// Root mean square of prediction minus reading, counts.
    double residual_count(const MacroPoint& point) const;

    /// Standard deviation of noise before rounding that explains the residual, at least a twentieth of a
    /// count.
    double noise_count(const MacroPoint& point) const;

    /// The influences of the readings on the active parameters, and their covariance by the likelihood.
    MacroInfluences influences(const MacroPoint& point, const MacroActive& active) const;

    /// A window's linearised prediction, to which lack-of-fit tests add columns.
    struct Linearised {
        std::vector<double> prediction_count;
        /// First and second derivative of -log likelihood by the predicted place, in counts.
        Eigen::VectorXd slopes, curvatures;
        Eigen::MatrixXd own;  ///< derivative of the place by each parameter, with the initial state refitted
        Eigen::MatrixXd starts;  ///< derivative of the place by the initial position and velocity
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
    MacroVector difference_;  ///< step sizes of the numerical derivatives
};

}  // namespace fidservo::calib
