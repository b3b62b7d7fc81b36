// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_step_response.h"

#include "calib/dense.h"
#include "calib/macro/macro_threshold.h"
#include "core/demand.h"
#include "core/failure.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace fidservo::calib {

namespace {

/// Share of a held command that already acts on the next sample: b1 / (b1 + b0) of the exact discretisation.
double early_share(double pole) {
    const double tau = -1.0 / std::log(pole);  // ticks
    return (1.0 - tau * (1.0 - pole)) / (1.0 - pole);
}

/// Sums of V' over the ticks before each sample.
Eigen::VectorXd summed_input(std::span<const double> volts, double pole) {
    const double share = early_share(pole);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(volts.size()));
    for (std::size_t k = 1; k < volts.size(); ++k) {
        const double before = k >= 2 ? volts[k - 2] : volts[0];
        sums[static_cast<Eigen::Index>(k)] =
            sums[static_cast<Eigen::Index>(k) - 1] + share * volts[k - 1] + (1.0 - share) * before;
    }
    return sums;
}

/// y[k] = p y[k-1] + b S[k], from 0.
Eigen::VectorXd response(const Eigen::VectorXd& sums, double pole, double numerator) {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(sums.size());
    for (Eigen::Index k = 1; k < sums.size(); ++k) y[k] = pole * y[k - 1] + numerator * sums[k];
    return y;
}

}  // namespace

Result<MacroEstimate> threshold_from_rising_steps(const MacroTrace& trace, double resolution_mm,
                                                  double side) {
    const std::vector<MacroWindow> whole{{trace.command_V, trace.position_mm, trace.tick_s}};
    const ThresholdInterval found = threshold_from_rest(whole, resolution_mm, side);
    if (!found.bounded())
        return failure(Reason::not_identifiable,
                       fmt::format("no command moved the carriage, up to {:.4g} V", found.above_V));
    if (found.above_V <= 0.0 || found.above_V >= found.most_V)
        return failure(Reason::not_identifiable,
                       fmt::format("the carriage left at {:.4g} V; no smaller command shows that it stays",
                                   found.most_V));
    return MacroEstimate{found.middle_V(), found.std_V()};
}

Result<StepModel> step_model(const MacroTrace& trace, std::span<const double> volts, double resolution_mm) {
    FIDSERVO_DEMAND(volts.size() == trace.position_mm.size() && resolution_mm > 0.0);
    constexpr int most_passes = 60;
    constexpr double first_pole = 0.9, settled = 1e-10;
    constexpr std::ptrdiff_t least_ticks = 20;
    const auto driven = std::count_if(volts.begin(), volts.end(), [](double v) { return v != 0.0; });
    const auto rows = static_cast<Eigen::Index>(volts.size());
    const auto unsettled = [](const char* why) {
        return failure(Reason::not_identifiable,
                       fmt::format("the step does not determine a pole between 0 and 1: {}", why));
    };
    if (driven < least_ticks) return unsettled("less than 20 driven ticks");

    Eigen::VectorXd y(rows);
    for (Eigen::Index k = 0; k < rows; ++k)
        y[k] = (trace.position_mm[static_cast<std::size_t>(k)] - trace.position_mm[0]) / resolution_mm;
    double pole = first_pole, numerator = 0.0;
    for (int pass = 1; pass <= most_passes; ++pass) {
        const Eigen::VectorXd sums = summed_input(volts, pole);
        Eigen::MatrixXd regressors(rows - 1, 3), instruments(rows - 1, 3);
        regressors << y.head(rows - 1), sums.tail(rows - 1), Eigen::VectorXd::Ones(rows - 1);
        instruments = regressors;
        // The first pass has no model yet; plain least squares starts it.
        if (pass > 1) instruments.col(0) = response(sums, pole, numerator).head(rows - 1);
        const Eigen::Vector3d solution = (instruments.transpose() * regressors)
                                             .fullPivLu()
                                             .solve(instruments.transpose() * y.tail(rows - 1));
        const double change = std::abs(solution[0] - pole);
        pole = solution[0];
        numerator = solution[1];
        if (!(pole > 0.0 && pole < 1.0)) return unsettled("it moves too little");
        if (pass > 1 && change < settled)
            return StepModel{numerator, pole, numerator * resolution_mm / ((1.0 - pole) * trace.tick_s),
                             -trace.tick_s / std::log(pole), pass};
    }
    return unsettled("the passes do not settle");
}

Result<DeadZoneModel> dead_zone_from_amplitudes(std::span<const SteadySpeed> speeds, double threshold_V,
                                                double unit_V) {
    constexpr double least_span = 0.05;
    const auto rows = static_cast<Eigen::Index>(speeds.size());
    double low_V = INFINITY, high_V = 0.0;
    Eigen::MatrixXd line(rows, 2);
    Eigen::VectorXd speed(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
        const SteadySpeed& point = speeds[static_cast<std::size_t>(i)];
        const double size_V = std::abs(point.command_V);
        low_V = std::min(low_V, size_V);
        high_V = std::max(high_V, size_V);
        line.row(i) << 1.0, size_V - unit_V;
        speed[i] = std::copysign(point.speed_mm_per_s, point.speed_mm_per_s * point.command_V);
    }
    if (rows < 2 || high_V - low_V < least_span * 0.5 * (high_V + low_V))
        return failure(Reason::not_identifiable, "a0 and delta need steps of several amplitudes");
    const Eigen::Vector2d fit = least_squares(line, speed);
    return DeadZoneModel{fit[0], 1.0 + fit[1] / fit[0] * (threshold_V - unit_V), fit[1] / fit[0]};
}

}  // namespace fidservo::calib
