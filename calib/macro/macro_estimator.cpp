// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_estimator.h"

#include "calib/rounding_likelihood.h"
#include "core/demand.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace fidservo::calib {

namespace {

constexpr double prior_width = 10.0;              // times what the data show
constexpr double prior_log_time_constant = -2.3;  // 0.1 s, within a factor of e^3
constexpr double prior_log_time_constant_std = 3.0;
constexpr double least_encoder_noise_count = 0.05;

/// Largest mean speed over 20 ms.
double fastest(const std::vector<MacroWindow>& windows) {
    double speed = 0.0;
    for (const MacroWindow& window : windows) {
        const auto span = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(0.02 / window.tick_s)),
                                                  1, window.position_mm.size() - 1);
        for (std::size_t k = span; k < window.position_mm.size(); ++k)
            speed = std::max(speed, std::abs(window.position_mm[k] - window.position_mm[k - span]) /
                                        (static_cast<double>(span) * window.tick_s));
    }
    return speed;
}

double largest_command_V(const std::vector<MacroWindow>& windows) {
    double size_V = 0.0;
    for (const MacroWindow& window : windows)
        for (const double u : window.command_V) size_V = std::max(size_V, std::abs(u));
    return size_V;
}

/// End of the block of ticks that begins at `begin`: 50 ms on, then until the reading changes, because the
/// error of rounding stays the same while the reading does.
std::size_t end_of_block(const MacroWindow& window, std::size_t begin) {
    constexpr double block_s = 0.05;
    const auto least =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(block_s / window.tick_s)));
    std::size_t end = std::min(begin + least, window.position_mm.size());
    while (end < window.position_mm.size() && window.position_mm[end] == window.position_mm[end - 1]) ++end;
    return end;
}

}  // namespace

MacroVector vector_of(const MacroMotion& motion) {
    return {motion.speed_mm_per_s, motion.slope_mm_per_s_per_V, motion.friction_mm_per_s, motion.offset_V,
            std::log(motion.time_constant_s)};
}

MacroMotion with_parameters(MacroMotion motion, const MacroVector& parameters) {
    motion.speed_mm_per_s = parameters[macro_index::speed];
    motion.slope_mm_per_s_per_V = parameters[macro_index::slope];
    motion.friction_mm_per_s = std::max(0.0, parameters[macro_index::friction]);
    motion.offset_V = parameters[macro_index::offset];
    constexpr double most_log = 700.0;  // whose exponential a number still holds, and that of its opposite
    motion.time_constant_s =
        std::exp(std::clamp(parameters[macro_index::log_time_constant], -most_log, most_log));
    return motion;
}

/// A window's share of gradient and curvature; x is its start (position, velocity), 0 the parameters.
struct MacroEstimator::Sums {
    MacroMatrix curvature = MacroMatrix::Zero();
    Eigen::Matrix<double, macro_parameter_count, 2> cross =
        Eigen::Matrix<double, macro_parameter_count, 2>::Zero();
    Eigen::Matrix2d start_curvature = Eigen::Matrix2d::Zero();
    MacroVector gradient = MacroVector::Zero();
    Eigen::Vector2d start_gradient = Eigen::Vector2d::Zero();
};

MacroEstimator::MacroEstimator(std::vector<MacroWindow> windows, double resolution_mm)
    : windows_(std::move(windows)), resolution_mm_(resolution_mm) {
    FIDSERVO_DEMAND(!windows_.empty() && resolution_mm > 0.0);
    const double command_V = std::max(largest_command_V(windows_), 1e-3);
    fastest_mm_per_s_ = std::max(fastest(windows_), resolution_mm);
    const double slope_scale = fastest_mm_per_s_ / command_V;
    const MacroVector scale{fastest_mm_per_s_, slope_scale, fastest_mm_per_s_, command_V, 1.0};
    prior_std_ = prior_width * scale;
    prior_std_[macro_index::log_time_constant] = prior_log_time_constant_std;
    difference_ = 1e-4 * scale;
}

MacroPoint MacroEstimator::start_at(const MacroMotion& motion) const {
    MacroPoint point{motion, {}, 1.0};
    point.starts.reserve(windows_.size());
    for (const MacroWindow& window : windows_) {
        const std::size_t span = std::min<std::size_t>(10, window.position_mm.size() - 1);
        point.starts.push_back({window.position_mm[0], (window.position_mm[span] - window.position_mm[0]) /
                                                           (static_cast<double>(span) * window.tick_s)});
    }
    return point;
}

std::vector<double> MacroEstimator::predict(std::size_t w, const MacroMotion& motion,
                                            const MacroMotionState& start) const {
    const MacroWindow& window = windows_[w];
    const MacroPropagation propagation(motion, window.tick_s);
    std::vector<double> place_count(window.position_mm.size());
    MacroMotionState state = start;
    for (std::size_t k = 0; k < place_count.size(); ++k) {
        place_count[k] = state.position_mm / resolution_mm_;
        propagation.advance(state, window.command_V[k]);
    }
    return place_count;
}

double MacroEstimator::start_std_mm(const MacroPoint& point) const {
    return resolution_mm_ * std::hypot(0.5, point.noise_count);
}

double MacroEstimator::start_loss(std::size_t w, const MacroPoint& point) const {
    const double place = (point.starts[w].position_mm - windows_[w].position_mm[0]) / start_std_mm(point);
    const double velocity = point.starts[w].velocity_mm_per_s / (prior_width * fastest_mm_per_s_);
    return 0.5 * (place * place + velocity * velocity);
}

double MacroEstimator::loss(const MacroPoint& point) const {
    MacroVector deviation = vector_of(point.motion);
    deviation[macro_index::log_time_constant] -= prior_log_time_constant;
    double total = 0.5 * deviation.cwiseQuotient(prior_std_).squaredNorm();
    std::vector<double> of_window(windows_.size());
    parallel_for(windows_.size(), [&](std::size_t w) {
        const std::vector<double> place_count = predict(w, point.motion, point.starts[w]);
        double sum = start_loss(w, point);
        for (std::size_t k = 0; k < place_count.size(); ++k)
            sum += rounding_loss_value(place_count[k] - windows_[w].position_mm[k] / resolution_mm_,
                                       point.noise_count);
        of_window[w] = sum;
    });
    return std::accumulate(of_window.begin(), of_window.end(), total);
}

double MacroEstimator::residual_count(const MacroPoint& point) const {
    double squares = 0.0, ticks = 0.0;
    for (std::size_t w = 0; w < windows_.size(); ++w) {
        for (const double error : errors_count(w, point)) squares += error * error;
        ticks += static_cast<double>(windows_[w].position_mm.size());
    }
    return std::sqrt(squares / ticks);
}

double MacroEstimator::noise_count(const MacroPoint& point) const {
    const double residual = residual_count(point);
    return std::max(least_encoder_noise_count, std::sqrt(std::max(0.0, residual * residual - 1.0 / 12.0)));
}

/// Columns: derivative of the predicted place (counts) by each parameter, then by the start's position and
/// velocity; central differences.
Eigen::MatrixXd MacroEstimator::sensitivities(std::size_t w, const MacroPoint& point,
                                              const MacroActive& active) const {
    const auto rows = static_cast<Eigen::Index>(windows_[w].position_mm.size());
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, macro_parameter_count + 2);
    const auto difference = [&](Eigen::Index column, const std::vector<double>& above,
                                const std::vector<double>& below, double width) {
        result.col(column) = (Eigen::Map<const Eigen::VectorXd>(above.data(), rows) -
                              Eigen::Map<const Eigen::VectorXd>(below.data(), rows)) /
                             width;
    };
    const MacroVector here = vector_of(point.motion);
    for (int i = 0; i < macro_parameter_count; ++i) {
        if (!active[static_cast<std::size_t>(i)]) continue;
        MacroVector above = here, below = here;
        above[i] += difference_[i];
        below[i] =
            i == macro_index::friction ? std::max(0.0, here[i] - difference_[i]) : here[i] - difference_[i];
        difference(i, predict(w, with_parameters(point.motion, above), point.starts[w]),
                   predict(w, with_parameters(point.motion, below), point.starts[w]), above[i] - below[i]);
    }
    result.col(macro_parameter_count).setConstant(1.0 / resolution_mm_);
    MacroMotionState faster = point.starts[w], slower = point.starts[w];
    faster.velocity_mm_per_s += difference_[macro_index::speed];
    slower.velocity_mm_per_s -= difference_[macro_index::speed];
    difference(macro_parameter_count + 1, predict(w, point.motion, faster), predict(w, point.motion, slower),
               2.0 * difference_[macro_index::speed]);
    return result;
}

/// A window's prediction and its derivatives by parameters and start.
struct MacroEstimator::Terms {
    std::vector<double> prediction_count;
    Eigen::MatrixXd jacobian;
    Eigen::VectorXd slopes, curvatures;  ///< of -log likelihood by the predicted place, per count
};

MacroEstimator::Terms MacroEstimator::terms(std::size_t w, const MacroPoint& point,
                                            const MacroActive& active) const {
    Terms terms{predict(w, point.motion, point.starts[w]), sensitivities(w, point, active), {}, {}};
    const Eigen::Index rows = terms.jacobian.rows();
    terms.slopes.resize(rows);
    terms.curvatures.resize(rows);
    for (Eigen::Index k = 0; k < rows; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const RoundingLoss loss = rounding_loss(
            terms.prediction_count[i] - windows_[w].position_mm[i] / resolution_mm_, point.noise_count);
        terms.slopes[k] = loss.slope;
        terms.curvatures[k] = loss.curvature;
    }
    return terms;
}

MacroEstimator::Sums MacroEstimator::sum_up(const Terms& terms, std::size_t w,
                                            const MacroPoint& point) const {
    const Eigen::MatrixXd& jacobian = terms.jacobian;
    const Eigen::VectorXd gradient = jacobian.transpose() * terms.slopes;
    const Eigen::MatrixXd curvature = jacobian.transpose() * terms.curvatures.asDiagonal() * jacobian;
    constexpr int n = macro_parameter_count;
    Sums sums{curvature.topLeftCorner<n, n>(), curvature.topRightCorner<n, 2>(),
              curvature.bottomRightCorner<2, 2>(), gradient.head<n>(), gradient.tail<2>()};
    const double place_std = start_std_mm(point), velocity_std = prior_width * fastest_mm_per_s_;
    const Eigen::Vector2d precision{1.0 / (place_std * place_std), 1.0 / (velocity_std * velocity_std)};
    sums.start_curvature.diagonal() += precision;
    sums.start_gradient[0] += precision[0] * (point.starts[w].position_mm - windows_[w].position_mm[0]);
    sums.start_gradient[1] += precision[1] * point.starts[w].velocity_mm_per_s;
    return sums;
}

double MacroEstimator::refine(MacroPoint& point, const MacroActive& active, int most_iterations,
                              double wanted) const {
    constexpr double least_gain = 1e-6, easiest = 1e-9, hardest = 1e9, most_that_follows = 10.0;
    double damping = 1e-3, here = loss(point);
    for (int iteration = 0; iteration < most_iterations && damping < hardest; ++iteration) {
        std::vector<Sums> sums(windows_.size());
        parallel_for(windows_.size(),
                     [&](std::size_t w) { sums[w] = sum_up(terms(w, point, active), w, point); });
        MacroMatrix curvature = prior_std_.cwiseAbs2().cwiseInverse().asDiagonal();
        MacroVector centre = vector_of(point.motion);
        centre[macro_index::log_time_constant] -= prior_log_time_constant;
        MacroVector gradient = centre.cwiseQuotient(prior_std_.cwiseAbs2());
        for (const Sums& of_window : sums) {
            curvature += of_window.curvature;
            gradient += of_window.gradient;
        }
        for (int i = 0; i < macro_parameter_count; ++i)
            if (!active[static_cast<std::size_t>(i)]) gradient[i] = 0.0;
        bool better = false;
        double gained = 0.0;
        while (!better && damping < hardest) {
            // The window starts are eliminated first (Schur complement): each couples to the parameters only.
            MacroMatrix reduced = curvature;
            reduced.diagonal() *= 1.0 + damping;
            MacroVector right = gradient;
            std::vector<Eigen::Matrix2d> inverse(sums.size());
            for (std::size_t w = 0; w < sums.size(); ++w) {
                Eigen::Matrix2d damped = sums[w].start_curvature;
                damped.diagonal() *= 1.0 + damping;
                inverse[w] = damped.inverse();
                reduced -= sums[w].cross * inverse[w] * sums[w].cross.transpose();
                right -= sums[w].cross * inverse[w] * sums[w].start_gradient;
            }
            const MacroVector step = -reduced.ldlt().solve(right);
            MacroPoint next = point;
            next.motion = with_parameters(point.motion, vector_of(point.motion) + step);
            for (std::size_t w = 0; w < sums.size(); ++w) {
                const Eigen::Vector2d move =
                    -inverse[w] * (sums[w].start_gradient + sums[w].cross.transpose() * step);
                next.starts[w].position_mm += move[0];
                next.starts[w].velocity_mm_per_s += move[1];
            }
            const double there = step.allFinite() && std::isfinite(next.motion.time_constant_s) &&
                                         next.motion.time_constant_s > 0.0
                                     ? loss(next)
                                     : here;
            better = there < here;
            damping = better ? std::max(easiest, 0.1 * damping) : 10.0 * damping;
            if (better) gained = here - there, point = std::move(next), here = there;
        }
        if (gained < least_gain || here - most_that_follows * gained > wanted) break;
    }
    return here;
}

MacroEstimator::Linearised MacroEstimator::linearised(Terms terms, const Sums& sums) {
    Linearised result{std::move(terms.prediction_count), std::move(terms.slopes),
                      std::move(terms.curvatures),       {},
                      terms.jacobian.rightCols<2>(),     sums.start_curvature};
    result.own = terms.jacobian.leftCols<macro_parameter_count>() -
                 result.starts * (sums.start_curvature.inverse() * sums.cross.transpose());
    return result;
}

MacroEstimator::Linearised MacroEstimator::linearised(std::size_t w, const MacroPoint& point,
                                                      const MacroActive& active) const {
    Terms of_window = terms(w, point, active);
    const Sums sums = sum_up(of_window, w, point);
    return linearised(std::move(of_window), sums);
}

std::vector<double> MacroEstimator::errors_count(std::size_t w, const MacroPoint& point) const {
    std::vector<double> errors = predict(w, point.motion, point.starts[w]);
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] -= windows_[w].position_mm[k] / resolution_mm_;
    return errors;
}

std::vector<MacroMotionState> MacroEstimator::course(std::size_t w, const MacroPoint& point) const {
    const MacroPropagation propagation(point.motion, windows_[w].tick_s);
    std::vector<MacroMotionState> states;
    states.reserve(windows_[w].command_V.size());
    MacroMotionState state = point.starts[w];
    for (const double command_V : windows_[w].command_V) {
        states.push_back(state);
        propagation.advance(state, command_V);
    }
    return states;
}

MacroInfluences MacroEstimator::influences(const MacroPoint& point, const MacroActive& active) const {
    constexpr int n = macro_parameter_count;
    MacroMatrix curvature = prior_information();
    std::vector<std::vector<MacroVector>> scores;
    for (std::size_t w = 0; w < windows_.size(); ++w) {
        Terms of_window = terms(w, point, active);
        const Sums sums = sum_up(of_window, w, point);
        const Linearised window = linearised(std::move(of_window), sums);
        curvature += sums.curvature - sums.cross * (sums.start_curvature.inverse() * sums.cross.transpose());
        if (scores.size() <= windows_[w].recording) scores.resize(windows_[w].recording + 1);
        for (std::size_t begin = 0; begin < windows_[w].position_mm.size();) {
            const std::size_t end = end_of_block(windows_[w], begin);
            MacroVector score = MacroVector::Zero();
            for (; begin < end; ++begin) {
                const auto k = static_cast<Eigen::Index>(begin);
                score -= window.slopes[k] * window.own.row(k).transpose();
            }
            scores[windows_[w].recording].push_back(score);
        }
    }
    // In units of the priors: the parameters' own differ by many powers of ten.
    const auto unit = prior_std_.asDiagonal();
    MacroInfluences result{unit * MacroMatrix(unit * curvature * unit).inverse() * unit, {}};
    for (const MacroWindow& window : windows_) {
        result.ticks += static_cast<double>(window.position_mm.size());
        result.starts += 2.0;
    }
    for (int i = 0; i < n; ++i) {
        result.fitted += active[static_cast<std::size_t>(i)] ? 1 : 0;
        if (active[static_cast<std::size_t>(i)]) continue;
        result.inverse.row(i).setZero();
        result.inverse.col(i).setZero();
    }
    for (const std::vector<MacroVector>& of_recording : scores) {
        auto& blocks = result.blocks.emplace_back(n, static_cast<Eigen::Index>(of_recording.size()));
        for (std::size_t j = 0; j < of_recording.size(); ++j)
            blocks.col(static_cast<Eigen::Index>(j)) = result.inverse * of_recording[j];
    }
    return result;
}

BatchVariance variance_along(const MacroInfluences& influences, const MacroVector& gradient) {
    std::vector<std::vector<double>> series;
    series.reserve(influences.blocks.size());
    for (const auto& blocks : influences.blocks) {
        const Eigen::RowVectorXd along = gradient.transpose() * blocks;
        series.emplace_back(along.data(), along.data() + along.size());
    }
    BatchVariance result = batch_variance(series, influences.fitted);
    const double freedom = std::max(1.0, influences.ticks - influences.starts);
    const double freer = std::max(1.0, freedom - static_cast<double>(influences.fitted));
    result.variance = std::max(result.variance * influences.ticks / freedom,
                               gradient.dot(influences.inverse * gradient) * influences.ticks / freer);
    result.freedom = std::min(result.freedom, freer);
    return result;
}

}  // namespace fidservo::calib
