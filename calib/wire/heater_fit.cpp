// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/heater_fit.h"

#include "calib/heterogeneity.h"
#include "calib/wire/heater_errors.h"
#include "core/failure.h"
#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr double least_share_of_stroke = 0.1;

std::string useless(HeaterNumber number, const HeaterScale& scale, const HeaterVector& x, double std) {
    HeaterVector beside = x;
    const auto i = static_cast<int>(number);
    beside(i) += 0.1;
    const double unit =
        std::abs(number_of(scale.at(beside.data()), i) - number_of(scale.at(x.data()), i)) / 0.1;
    return fmt::format("the data leave it at {:.4g} +- {:.2g}: it hardly shows, or not apart from the others",
                       number_of(scale.at(x.data()), i), unit * std);
}

/// Fits from x on, and while a standard error is useless holds the worst number at the scale's start and fits
/// again.
Result<HeaterSolution> fit_determined(const std::vector<HeaterRun>& runs, const HeaterPredict& predict,
                                      const HeaterScale& scale, HeaterVector begin) {
    const HeaterResiduals residuals(runs, predict, scale);
    if (residuals.count() < static_cast<int>(least_heater_rows))
        return failure(Reason::not_identifiable,
                       fmt::format("{} usable rows: {} are needed", residuals.count(), least_heater_rows));
    HeaterFree is_free{true, true, true, true, true};
    HeaterVector x = begin;
    HeaterFit fit{};
    fit.samples = static_cast<std::size_t>(residuals.count());
    std::optional<HeaterSolution::Freer> freer;
    for (;;) {
        if (!solve_heater(residuals, is_free, scale.by_itself, x))
            return failure(Reason::no_convergence, "the heater's fit did not converge");
        const Eigen::VectorXd residual = residuals.at(x);
        if (!residual.allFinite())
            return failure(Reason::no_convergence, "the heater's fit did not converge");
        const double squares = residual.squaredNorm();
        const HeaterInfluences influences = influences_at(residuals, is_free, x);
        const HeaterVector std = parameter_stds(influences);
        if (scale.by_itself && is_free[0] && x(0) < 1e-6) {
            if (!freer) freer = {x, influences};
            if (std(0) > 1.0)
                add_combination(fit, HeaterNumber::onset, residuals, scale, freer->x, freer->influences,
                                mean_heating_command(runs, scale.at(freer->x.data())));
            fit.refused.push_back({HeaterNumber::onset, "the heater heats from the least command on"});
            is_free[0] = false;
            begin(0) = 0.0;
            x = begin;
            continue;
        }
        fit.residual_rms = std::sqrt(squares / residuals.weight_squares());
        const double variation = residuals.variation();
        fit.missed_share = variation > 0.0 ? std::sqrt(squares / variation) : 1.0;
        int worst = 0;
        if (std.maxCoeff(&worst) <= 1.0) {
            fit.heater = scale.at(x.data());
            HeaterSolution solution{fit, x, is_free, freer};
            refuse_what_hangs_on_others(solution);
            return solution;
        }
        if (!freer) freer = {x, influences};
        if (scale.by_itself) {
            HeaterVector can_be_held = std;
            can_be_held(1) = can_be_held(3) = 0.0;
            if (can_be_held.maxCoeff() > 0.0) can_be_held.maxCoeff(&worst);
        }
        const auto number = static_cast<HeaterNumber>(worst);
        if (scale.by_itself && (number == HeaterNumber::gain || number == HeaterNumber::cooling_tau))
            return failure(Reason::not_identifiable,
                           fmt::format("{}: {}", name_of(number), useless(number, scale, x, std(worst))));
        add_combination(fit, number, residuals, scale, freer->x, freer->influences,
                        mean_heating_command(runs, scale.at(freer->x.data())));
        fit.refused.push_back({number, useless(number, scale, x, std(worst))});
        is_free[static_cast<std::size_t>(worst)] = false;
        begin(worst) = 0.0;
        x = begin;
    }
}

/// The solution with the least squares from several time constants.
HeaterVector best_of_starts(const std::vector<HeaterRun>& runs, const HeaterScale& scale) {
    const HeaterPredict predict = predict_temperature;
    const HeaterResiduals residuals(runs, predict, scale);
    HeaterVector best = HeaterVector::Zero();
    if (residuals.count() == 0) return best;
    double least = std::numeric_limits<double>::infinity();
    for (const double share : {0.03, 0.1, 0.3, 1.0, 3.0}) {
        HeaterVector x = HeaterVector::Zero();
        x(3) = std::log(share) / 0.2;
        if (!solve_heater(residuals, {true, true, false, true, false}, scale.by_itself, x)) continue;
        const double squares = residuals.at(x).squaredNorm();
        if (squares < least) best = x, least = squares;
    }
    return best;
}

/// What runs that have no common solution say of the gain by themselves; empty for one run.
std::string each_alone(const std::vector<HeaterRun>& runs, const HeaterScale& scale) {
    constexpr double level = 0.01;
    std::vector<RecordingEstimate> own;
    std::string text;
    for (const HeaterRun& run : runs) {
        if (runs.size() < 2) break;
        const std::vector<HeaterRun> alone{run};
        const auto fit = fit_determined(alone, predict_temperature, scale, best_of_starts(alone, scale));
        if (!fit) continue;
        const HeaterFit with = with_errors(alone, predict_temperature, scale, *fit);
        constexpr auto gain = static_cast<std::size_t>(HeaterNumber::gain);
        if (!(with.std[gain] > 0.0)) continue;
        own.push_back({with.heater.gain_degC_per_V, with.std[gain], with.freedom[gain]});
        text += fmt::format("{}{:.4g} +- {:.2g}", text.empty() ? "" : ", ", own.back().value, own.back().std);
    }
    return heterogeneity(own).probability < level
               ? "; the recordings contradict each other on it, alone they say " + text
               : "";
}

Status check(const std::vector<HeaterRun>& runs) {
    const auto usable = [](double value) { return std::isfinite(value) && std::abs(value) < 1e9; };
    if (runs.empty()) return failure(Reason::not_identifiable, "there are no recordings");
    for (const HeaterRun& run : runs) {
        const std::size_t n = run.reading.size();
        const bool fits = run.command.size() == n && (run.weight.empty() || run.weight.size() == n) &&
                          (run.ambient_degC.empty() || run.ambient_degC.size() == n) && run.tick_s > 0.0;
        if (!fits || n == 0) return failure(Reason::not_identifiable, "a recording is empty");
        if (!std::ranges::all_of(run.reading, usable) || !std::ranges::all_of(run.command, usable) ||
            !std::ranges::all_of(run.weight, usable) || !std::ranges::all_of(run.ambient_degC, usable))
            return failure(Reason::not_identifiable, "a recording holds values that are not usable numbers");
    }
    return {};
}

struct ColumnRange {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    double size() const { return high - low; }
};

ColumnRange range_over(const std::vector<HeaterRun>& runs, std::vector<double> HeaterRun::*column) {
    ColumnRange range;
    for (const HeaterRun& run : runs)
        for (const double value : run.*column) {
            range.low = std::min(range.low, value);
            range.high = std::max(range.high, value);
        }
    return range;
}

/// The runs with the temperature inferred in place of the Hall readings, every 20th row.
std::vector<HeaterRun> inferred_runs(const MicroModel& model, const std::vector<HeaterRun>& runs) {
    constexpr std::size_t stride = 20;
    std::vector<HeaterRun> inferred = runs;
    for (HeaterRun& run : inferred) {
        InferredTemperature wire = infer_temperature(model, run.reading);
        run.reading = std::move(wire.temp_degC);
        run.weight = std::move(wire.sensitivity_lsb_per_degC);
        for (std::size_t k = 0; k < run.weight.size(); ++k)
            if (k % stride != 0) run.weight[k] = 0.0;
    }
    return inferred;
}

/// Each run whose start is its first reading, started a residual higher.
std::vector<HeaterVector> moves_by_starts(const std::vector<HeaterRun>& runs,
                                          const std::vector<HeaterRun>& started, const HeaterScale& scale,
                                          const HeaterSolution& solution) {
    std::vector<HeaterVector> moves;
    const HeaterPredict predict = predict_temperature;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        if (runs[r].start_degC) continue;
        std::vector<HeaterRun> other = started;
        *other[r].start_degC += solution.fit.residual_rms;
        HeaterVector x = solution.x;
        if (solve_heater(HeaterResiduals(other, predict, scale), solution.is_free, scale.by_itself, x))
            moves.emplace_back(x - solution.x);
    }
    return moves;
}

}  // namespace

std::string_view name_of(HeaterNumber number) {
    constexpr std::array<std::string_view, heater_numbers> names{"onset", "gain", "heating_tau",
                                                                 "cooling_tau", "ambient"};
    return names[static_cast<std::size_t>(number)];
}

std::vector<double> predict_temperature(const HeaterParameters& heater, const HeaterRun& run) {
    std::vector<double> temp;
    if (run.command.empty()) return temp;
    temp.reserve(run.command.size());
    const auto ambient = [&](std::size_t k) {
        return heater.ambient_degC + (run.ambient_degC.empty() ? 0.0 : run.ambient_degC[k]);
    };
    const double heating = -std::expm1(-run.tick_s / heater.heating_tau_s);
    const double cooling = -std::expm1(-run.tick_s / heater.cooling_tau_s);
    double now = run.start_degC.value_or(ambient(0));
    for (std::size_t k = 0; k < run.command.size(); ++k) {
        temp.push_back(now);
        const double way = heater_rise_degC(heater, run.command[k]) - (now - ambient(k));
        now += way * (way > 0.0 ? heating : cooling);
    }
    return temp;
}

std::vector<double> predict_hall(const MicroModel& model, const HeaterParameters& heater,
                                 const HeaterRun& run) {
    std::vector<double> adc = predict_temperature(heater, run);
    if (adc.empty()) return adc;
    const double lsb_V = hall_lsb_V(model.hall);
    PreisachMemory wire = preisach_start(*model.fod, adc.front());
    for (double& value : adc) {
        const double x_mm = model.stroke_scale * preisach_step(*model.fod, wire, value);
        value = hall_voltage_V(model.hall, x_mm) / lsb_V;
    }
    return adc;
}

Result<HeaterFit> fit_heater(const MicroModel& model, const std::vector<HeaterRun>& runs) {
    if (const Status checked = check(runs); !checked) return tl::make_unexpected(checked.error());
    const ColumnRange adc = range_over(runs, &HeaterRun::reading);
    const double stroke_lsb = (hall_voltage_V(model.hall, model.stroke_scale * model.fod->stroke_mm()) -
                               hall_voltage_V(model.hall, 0.0)) /
                              hall_lsb_V(model.hall);
    if (adc.size() < least_share_of_stroke * stroke_lsb)
        return failure(Reason::not_identifiable, "the platform moved by less than a tenth of its stroke");
    const HeaterScale scale{model.heater, std::max(model.heater.limit_V - model.heater.onset_V, 1e-3)};
    HeaterVector x = HeaterVector::Zero();
    // A start that the data make; where it cannot be had, the model's own numbers are one too.
    if (const auto start = fit_determined(inferred_runs(model, runs), predict_temperature, scale, x))
        x = start->x;
    const HeaterPredict predict = [&](const HeaterParameters& heater, const HeaterRun& run) {
        return predict_hall(model, heater, run);
    };
    auto best = fit_determined(runs, predict, scale, x);
    if (!best) return tl::make_unexpected(best.error());
    return with_errors(runs, predict, scale, *best);
}

Result<HeaterFit> fit_heater_to_temperature(const std::vector<HeaterRun>& runs) {
    if (const Status checked = check(runs); !checked) return tl::make_unexpected(checked.error());
    const ColumnRange command = range_over(runs, &HeaterRun::command),
                      temp = range_over(runs, &HeaterRun::reading);
    if (!(command.size() > 0.0)) return failure(Reason::not_identifiable, "the command does not move");
    if (!(temp.size() > 0.0)) return failure(Reason::not_identifiable, "the temperature does not move");
    std::vector<HeaterRun> started = runs;
    double longest_s = 0.0;
    for (HeaterRun& run : started) {
        if (!run.start_degC) run.start_degC = run.reading.front();
        longest_s = std::max(longest_s, run.tick_s * static_cast<double>(run.reading.size()));
    }
    const HeaterRun& first = started.front();
    const double rest_degC =
        first.reading.front() - (first.ambient_degC.empty() ? 0.0 : first.ambient_degC.front());
    const HeaterScale scale{{.onset_V = command.low,
                             .limit_V = command.high,
                             .gain_degC_per_V = temp.size() / command.size(),
                             .heating_tau_s = 0.1 * longest_s,
                             .cooling_tau_s = 0.1 * longest_s,
                             .ambient_degC = rest_degC},
                            command.size(),
                            true};
    auto best = fit_determined(started, predict_temperature, scale, best_of_starts(started, scale));
    if (!best)
        return tl::make_unexpected(
            Failure{best.error().reason, best.error().text + each_alone(started, scale)});
    best->moved_by_starts = moves_by_starts(runs, started, scale, *best);
    return with_errors(started, predict_temperature, scale, *best);
}

}  // namespace fidservo::calib
