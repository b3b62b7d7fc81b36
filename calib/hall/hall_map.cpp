// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/hall/hall_map.h"

#include "calib/dense.h"
#include "core/failure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

namespace fidservo::calib {

namespace {

constexpr double least_travel_mm = 1.0;
constexpr double cubic_travel_mm = 2.5;  ///< less travel in view determines the scale only
constexpr std::size_t least_sights = 12;
constexpr double earliest_delay_s = -0.020, latest_delay_s = 0.120, delay_step_s = 0.001;

/// Nominal Hall positions relative to the sensor's centre, and their running sum for averages over exposures.
class NominalTrace {
  public:
    NominalTrace(const HallParameters& hall, const HallTrace& trace)
        : trace_(trace), sum_(trace.adc.size() + 1, 0.0) {
        for (std::size_t k = 0; k < trace.adc.size(); ++k)
            sum_[k + 1] = sum_[k] + hall_position_mm_of_adc(hall, trace.adc[k]) - hall.centre_mm;
    }

    /// Mean over [time - width/2, time + width/2]; NaN where the trace does not cover it.
    double mean_mm(double time_s, double width_s) const {
        const double tick_s = seconds(trace_.tick_ns);
        const double from = (time_s - 0.5 * width_s) / tick_s + 0.5, to = from + width_s / tick_s;
        if (from < 0.0 || to > static_cast<double>(trace_.adc.size())) return std::nan("");
        return (integral(to) - integral(from)) / (to - from);
    }

    double first_mm(int ticks) const { return sum_[static_cast<std::size_t>(ticks)] / ticks; }

  private:
    double integral(double tick) const {
        const auto k = std::min(static_cast<std::size_t>(tick), sum_.size() - 2);
        return sum_[k] + (tick - static_cast<double>(k)) * (sum_[k + 1] - sum_[k]);
    }

    const HallTrace& trace_;
    std::vector<double> sum_;
};

struct MapFit {
    Eigen::VectorXd coefficients;  ///< y, k1, k2, k3 (or y, k1)
    double slope_std = 0.0;
    double squares = std::numeric_limits<double>::infinity();
    double travel_mm = 0.0;
    Eigen::Index sights = 0;
};

MapFit fit_at_delay(const NominalTrace& trace, TimeNs start_ns, std::span<const CameraSight> sights,
                    double exposure_s, double delay_s) {
    std::vector<std::pair<double, double>> pairs;
    for (const CameraSight& sight : sights) {
        const double d_mm = trace.mean_mm(seconds(sight.time_ns - start_ns) - delay_s, exposure_s);
        if (std::isfinite(d_mm)) pairs.emplace_back(d_mm, sight.s_mm);
    }
    if (pairs.size() < least_sights) return {};
    const auto [low, high] = std::minmax_element(pairs.begin(), pairs.end());
    MapFit fit;
    fit.travel_mm = high->first - low->first;
    fit.sights = static_cast<Eigen::Index>(pairs.size());
    const Eigen::Index terms = fit.travel_mm >= cubic_travel_mm ? 4 : 2;
    Eigen::MatrixXd a(fit.sights, terms);
    Eigen::VectorXd s(fit.sights);
    for (Eigen::Index i = 0; i < fit.sights; ++i) {
        const auto& [d_mm, s_mm] = pairs[static_cast<std::size_t>(i)];
        for (Eigen::Index j = 0; j < terms; ++j) a(i, j) = std::pow(d_mm, static_cast<double>(j));
        s(i) = s_mm;
    }
    fit.coefficients = least_squares(a, s);
    fit.squares = (a * fit.coefficients - s).squaredNorm();
    const Eigen::MatrixXd inverse = inverse_of_gram(a);
    fit.slope_std = std::sqrt(inverse(1, 1) * fit.squares / static_cast<double>(fit.sights - terms));
    return fit;
}

}  // namespace

Result<HallMap> fit_hall_map(const HallParameters& hall, const HallTrace& trace,
                             std::span<const CameraSight> sights, double exposure_s, int rest_ticks) {
    const NominalTrace nominal(hall, trace);
    const auto at = [&](double delay_s) {
        return fit_at_delay(nominal, trace.start_ns, sights, exposure_s, delay_s);
    };
    double best_s = 0.0, best_squares = std::numeric_limits<double>::infinity();
    for (double delay_s = earliest_delay_s; delay_s <= latest_delay_s; delay_s += delay_step_s) {
        const double squares = at(delay_s).squares;
        if (squares < best_squares) best_s = delay_s, best_squares = squares;
    }
    if (!std::isfinite(best_squares))
        return failure(Reason::not_identifiable, "the tuning sweep was seen in fewer than 12 frames");
    // The sum of squares is a parabola in the delay near its minimum.
    const double below = at(best_s - delay_step_s).squares, above = at(best_s + delay_step_s).squares;
    const double curvature = (below - 2.0 * best_squares + above) / (delay_step_s * delay_step_s);
    if (std::isfinite(curvature) && curvature > 0.0)
        best_s += (below - above) / (2.0 * delay_step_s * curvature);
    const MapFit fit = at(best_s);
    if (!(fit.travel_mm >= least_travel_mm))
        return failure(Reason::not_identifiable,
                       "the platform moved less than 1 mm in view during the tuning sweep");

    HallMap map{};
    map.correction = {0.0, fit.coefficients(1), 0.0, 0.0};
    if (fit.coefficients.size() == 4)
        map.correction = {0.0, fit.coefficients(1), fit.coefficients(2), fit.coefficients(3)};
    const double rest_mm = nominal.first_mm(rest_ticks);
    const auto& k = map.correction;
    map.correction[0] = -rest_mm * (k[1] + rest_mm * (k[2] + rest_mm * k[3]));
    const double variance = fit.squares / static_cast<double>(fit.sights - fit.coefficients.size());
    map.camera_delay_s = best_s;
    map.camera_delay_std_s = curvature > 0.0 ? std::sqrt(2.0 * variance / curvature) : 0.0;
    map.scale_std = fit.slope_std;
    map.residual_mm = std::sqrt(variance);
    return map;
}

}  // namespace fidservo::calib
