// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/hall/hall_curve.h"

#include "calib/dense.h"
#include "calib/wire/preisach_data.h"
#include "core/demand.h"
#include "core/failure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr std::size_t least_samples = 20;
constexpr double least_share_of_travel = 0.05;
constexpr double significance = 4.0;  ///< standard errors that the third power must be away from zero
constexpr double largest_end_error_lsb = 4.0;  ///< of the curve, where it is to be used beyond the data

using Polynomial = Eigen::Vector4d;

/// The four numbers of a cubic: mid V, span V, centre mm, cubic.
Eigen::Vector4d numbers_of(const Polynomial& p, double half_range_mm) {
    const double h3 = half_range_mm * half_range_mm * half_range_mm;
    const double centre = -p(2) / (3.0 * p(3));
    const double mid = p(0) + centre * (p(1) + centre * (p(2) + centre * p(3)));
    const double span = (p(1) - p(2) * p(2) / (3.0 * p(3))) * half_range_mm + p(3) * h3;
    return {mid, span, centre, -p(3) * h3 / span};
}

/// Derivatives of the four numbers by the polynomial's coefficients, by central differences.
Eigen::Matrix4d derivatives(const Polynomial& p, const Eigen::Vector4d& std, double half_range_mm) {
    Eigen::Matrix4d jacobian;
    for (int i = 0; i < 4; ++i) {
        Polynomial up = p, down = p;
        const double step = 1e-3 * std(i) + 1e-12 * std::abs(p(i)) + 1e-300;
        up(i) += step;
        down(i) -= step;
        jacobian.col(i) = (numbers_of(up, half_range_mm) - numbers_of(down, half_range_mm)) / (2.0 * step);
    }
    return jacobian;
}

/// A linear fit with what is needed to judge it. Powers of x - about, which keeps the columns apart.
struct CurveFit {
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd covariance;
    double rms = 0.0;
};

CurveFit fit_columns(const Eigen::MatrixXd& a, const Eigen::VectorXd& v, double floor) {
    CurveFit fit;
    fit.coefficients = least_squares(a, v);
    const Eigen::VectorXd residual = v - a * fit.coefficients;
    const auto freedom = static_cast<double>(a.rows() - a.cols());
    const double variance = std::max(residual.squaredNorm() / freedom, floor * floor);
    const double length = correlation_length({residual.data(), static_cast<std::size_t>(residual.size())});
    fit.covariance = inverse_of_gram(a) * variance * length;
    fit.rms = std::sqrt(residual.squaredNorm() / static_cast<double>(a.rows()));
    return fit;
}

struct Data {
    Eigen::VectorXd reference_mm, reading_V;
    std::size_t saturated = 0;
};

Data usable(const HallParameters& hall, std::span<const HallSample> samples) {
    std::vector<double> x, v;
    x.reserve(samples.size());
    v.reserve(samples.size());
    const double highest = std::exp2(hall.adc_bits) - 1.0;
    Data data;
    for (const HallSample& sample : samples) {
        if (!std::isfinite(sample.reference_mm) || !std::isfinite(sample.adc) ||
            std::abs(sample.reference_mm) > 1e9)
            continue;
        if (sample.adc <= 0.0 || sample.adc >= highest) {
            ++data.saturated;
            continue;
        }
        x.push_back(sample.reference_mm);
        v.push_back(sample.adc * hall_lsb_V(hall));
    }
    data.reference_mm = Eigen::VectorXd::Map(x.data(), static_cast<Eigen::Index>(x.size()));
    data.reading_V = Eigen::VectorXd::Map(v.data(), static_cast<Eigen::Index>(v.size()));
    return data;
}

/// Mid and span with centre and cubic as the nominal curve has them.
CurveFit fit_nominal_line(const HallParameters& nominal, const Data& data, double floor_V) {
    HallParameters unit = nominal;
    unit.mid_V = 0.0;
    unit.span_V = 1.0;
    Eigen::MatrixXd a(data.reference_mm.size(), 2);
    a.col(0).setOnes();
    for (Eigen::Index k = 0; k < a.rows(); ++k) a(k, 1) = hall_voltage_V(unit, data.reference_mm(k));
    return fit_columns(a, data.reading_V, floor_V);
}

CurveFit fit_cubic(const Data& data, double about_mm, double floor_V) {
    Eigen::MatrixXd a(data.reference_mm.size(), 4);
    const Eigen::ArrayXd d = data.reference_mm.array() - about_mm;
    a << Eigen::VectorXd::Ones(d.size()), d.matrix(), d.square().matrix(), d.cube().matrix();
    return fit_columns(a, data.reading_V, floor_V);
}

double end_error_V(const CurveFit& cubic, double at_mm) {
    const Eigen::Vector4d powers(1.0, at_mm, at_mm * at_mm, at_mm * at_mm * at_mm);
    return std::sqrt(powers.dot(cubic.covariance * powers));
}

/// Where references were and where the curve is to hold, mm.
struct Cover {
    double low_mm, high_mm, travel_low_mm, travel_high_mm;

    /// Whether the references leave out at least a tenth of the travel at either end.
    bool misses_an_end() const {
        const double tenth_mm = 0.1 * (travel_high_mm - travel_low_mm);
        return low_mm > travel_low_mm + tenth_mm || high_mm < travel_high_mm - tenth_mm;
    }
    std::string text() const {
        return fmt::format("references from {:.3g} to {:.3g} mm of a travel from {:.3g} to {:.3g} mm{}",
                           low_mm, high_mm, travel_low_mm, travel_high_mm,
                           misses_an_end() ? ": more are needed towards its ends" : "");
    }
};

/// Why a cubic is not a curve to be trusted over the travel; empty if it is.
std::string doubt(const CurveFit& cubic, double worst_end_lsb, const Cover& cover) {
    const double bend_std = std::sqrt(cubic.covariance(3, 3));
    if (!std::isfinite(bend_std) || std::abs(cubic.coefficients(3)) < significance * bend_std)
        return "the readings do not show the curve's bend, which centre and cubic are from: " + cover.text();
    if (cubic.coefficients(3) > 0.0)
        return "the curve steepens towards its ends: no slide-by Hall curve does";
    if (worst_end_lsb > largest_end_error_lsb)
        return fmt::format("at an end of the travel the curve would be uncertain by {:.1f} LSB: {}",
                           worst_end_lsb, cover.text());
    return {};
}

void state_resolution(HallCurve& curve, double low_mm, double high_mm) {
    const double lsb_V = hall_lsb_V(curve.hall), um_per_mm = 1000.0;
    const double rise_V = hall_voltage_V(curve.hall, high_mm) - hall_voltage_V(curve.hall, low_mm);
    curve.mean_um_per_bit = um_per_mm * (high_mm - low_mm) / (rise_V / lsb_V);
    const auto at = [&](double x_mm) { return um_per_mm * lsb_V / hall_slope_V_per_mm(curve.hall, x_mm); };
    curve.finest_um_per_bit = at(std::clamp(curve.hall.centre_mm, low_mm, high_mm));
    curve.coarsest_um_per_bit = std::max(at(low_mm), at(high_mm));
}

}  // namespace

Result<HallCurve> fit_hall_curve(const HallParameters& nominal, std::span<const HallSample> samples,
                                 double travel_low_mm, double travel_high_mm) {
    const auto refuse = [](std::string text) { return failure(Reason::not_identifiable, std::move(text)); };
    FIDSERVO_DEMAND(travel_low_mm < travel_high_mm && nominal.half_range_mm > 0.0);
    const Data data = usable(nominal, samples);
    const auto n = static_cast<std::size_t>(data.reference_mm.size());
    if (n < least_samples) return refuse(fmt::format("{} usable readings: {} are needed", n, least_samples));
    const double low = data.reference_mm.minCoeff(), high = data.reference_mm.maxCoeff();
    if (high - low < least_share_of_travel * (travel_high_mm - travel_low_mm))
        return refuse(fmt::format("the references cover {:.3g} mm of {:.3g} mm of travel", high - low,
                                  travel_high_mm - travel_low_mm));

    const double floor_V = hall_lsb_V(nominal) / std::sqrt(12.0);
    const CurveFit line = fit_nominal_line(nominal, data, floor_V);
    const double span_V = line.coefficients(1);
    if (!(span_V > significance * std::sqrt(line.covariance(1, 1))))
        return refuse("the readings do not rise with the references");
    HallCurve curve{.hall = nominal,
                    .mid_std_V = std::sqrt(line.covariance(0, 0)),
                    .span_std_V = std::sqrt(line.covariance(1, 1)),
                    .centre_std_mm = std::nan(""),
                    .cubic_std = std::nan(""),
                    .refused = std::nullopt,
                    .residual_lsb = line.rms / hall_lsb_V(nominal),
                    .low_mm = low,
                    .high_mm = high,
                    .mean_um_per_bit = 0.0,
                    .finest_um_per_bit = 0.0,
                    .coarsest_um_per_bit = 0.0,
                    .samples = n,
                    .saturated = data.saturated};
    curve.hall.mid_V = line.coefficients(0);
    curve.hall.span_V = span_V;

    const double about = 0.5 * (low + high);
    const CurveFit cubic = fit_cubic(data, about, floor_V);
    const double worst_end_lsb =
        std::max(end_error_V(cubic, travel_low_mm - about), end_error_V(cubic, travel_high_mm - about)) /
        hall_lsb_V(nominal);
    if (std::string reason = doubt(cubic, worst_end_lsb, {low, high, travel_low_mm, travel_high_mm});
        !reason.empty()) {
        curve.refused = Failure{Reason::not_identifiable, std::move(reason)};
    } else {
        const Eigen::Vector4d numbers = numbers_of(cubic.coefficients, nominal.half_range_mm);
        const Eigen::Matrix4d jacobian =
            derivatives(cubic.coefficients, cubic.covariance.diagonal().cwiseSqrt(), nominal.half_range_mm);
        const Eigen::Vector4d std =
            (jacobian * cubic.covariance * jacobian.transpose()).diagonal().cwiseSqrt();
        curve.hall.mid_V = numbers(0);
        curve.hall.span_V = numbers(1);
        curve.hall.centre_mm = numbers(2) + about;
        curve.hall.cubic = numbers(3);
        curve.mid_std_V = std(0);
        curve.span_std_V = std(1);
        curve.centre_std_mm = std(2);
        curve.cubic_std = std(3);
        curve.residual_lsb = cubic.rms / hall_lsb_V(nominal);
    }
    state_resolution(curve, travel_low_mm, travel_high_mm);
    return curve;
}

}  // namespace fidservo::calib
