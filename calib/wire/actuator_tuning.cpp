// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/actuator_tuning.h"

#include "core/demand.h"
#include "core/failure.h"
#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>

#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

namespace fidservo::calib {

namespace {

constexpr std::size_t tick_stride = 5;  ///< every fifth tick enters the fit
constexpr int deviations = 5;

/// Offsets and factors relative to the rig file: ambient [degC], stroke, gain, heating tau, cooling tau.
using Deviation = std::array<double, deviations>;
constexpr Deviation nominal_deviation{0.0, 1.0, 1.0, 1.0, 1.0};
constexpr Deviation lowest_deviation{-15.0, 0.85, 0.8, 0.7, 0.7};
constexpr Deviation highest_deviation{15.0, 1.15, 1.25, 1.4, 1.4};

HeaterParameters deviate(const HeaterParameters& heater, const double* x) {
    HeaterParameters result = heater;
    result.ambient_degC += x[0];
    result.gain_degC_per_V *= x[2];
    result.heating_tau_s *= x[3];
    result.cooling_tau_s *= x[4];
    return result;
}

class SweepResidual {
  public:
    SweepResidual(const MicroModel& model, double tick_s, std::span<const double> position_mm,
                  std::span<const double> command_V)
        : model_(model), tick_s_(tick_s), position_mm_(position_mm), command_V_(command_V) {}

    int count() const { return static_cast<int>(position_mm_.size() / tick_stride); }

    bool operator()(double const* const* blocks, double* residual_mm) const {
        const double* x = blocks[0];
        const HeaterParameters heater = deviate(model_.heater, x);
        PreisachMemory wire = preisach_start(*model_.fod, heater.ambient_degC);
        int next = 0;
        for (std::size_t k = 0; next < count(); ++k) {
            if (k % tick_stride == 0) residual_mm[next++] = x[1] * wire.contraction_mm - position_mm_[k];
            preisach_step(*model_.fod, wire,
                          heater_step_degC(heater, wire.temp_degC, command_V_[k], tick_s_));
        }
        return true;
    }

  private:
    const MicroModel& model_;
    double tick_s_;
    std::span<const double> position_mm_, command_V_;
};

}  // namespace

Result<ActuatorTuning> tune_actuator(const MicroModel& model, double tick_s,
                                     std::span<const double> position_mm, std::span<const double> command_V) {
    FIDSERVO_DEMAND(position_mm.size() == command_V.size() && !position_mm.empty());
    const auto [low, high] = std::minmax_element(position_mm.begin(), position_mm.end());
    if (*high - *low < 0.5 * model.fod->stroke_mm())
        return failure(Reason::not_identifiable,
                       "the tuning sweep moved the platform by less than half its stroke");

    SweepResidual residual(model, tick_s, position_mm, command_V);
    const int count = residual.count();
    Deviation x = nominal_deviation;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::DynamicNumericDiffCostFunction<SweepResidual, ceres::CENTRAL> cost(&residual,
                                                                              ceres::DO_NOT_TAKE_OWNERSHIP);
    cost.AddParameterBlock(deviations);
    cost.SetNumResiduals(count);
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(&cost, nullptr, x.data());
    for (int i = 0; i < deviations; ++i) {
        problem.SetParameterLowerBound(x.data(), i, lowest_deviation[static_cast<std::size_t>(i)]);
        problem.SetParameterUpperBound(x.data(), i, highest_deviation[static_cast<std::size_t>(i)]);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 60;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
        return failure(Reason::no_convergence, "the actuator's tuning did not converge");
    return ActuatorTuning{deviate(model.heater, x.data()), x[1], std::sqrt(2.0 * summary.final_cost / count)};
}

}  // namespace fidservo::calib
