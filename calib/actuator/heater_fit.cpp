#include "calib/actuator/heater_fit.h"

#include "calib/batch_variance.h"
#include "calib/heterogeneity.h"
#include "calib/tails.h"
#include "core/failure.h"
#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Dense>
#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr int numbers = static_cast<int>(heater_numbers);
constexpr std::size_t most_heater_rows = 40'000;
constexpr std::size_t least_rows = 50;
constexpr double least_share_of_stroke = 0.1;

using Vector = Eigen::Matrix<double, numbers, 1>;
using Predict = std::function<std::vector<double>(const HeaterParameters&, const HeaterRun&)>;

/// Numbers relative to a start, in units in which a standard error of one is useless: a fifth of gain and of
/// time constants, a twentieth of the commands' range, 1 degC.
struct Scale {
    HeaterParameters start;
    double command_range;
    /// No rig file behind it: the onset is not below the start's, the third number is the heating tau over
    /// the cooling tau, and gain and cooling tau cannot be held for want of a value.
    bool by_itself = false;

    HeaterParameters at(const double* x) const {
        constexpr double fifth = 0.2, twentieth = 0.05, ambient_degC = 1.0;
        HeaterParameters heater = start;
        heater.onset_V += twentieth * command_range * x[0];
        heater.gain_degC_per_V *= std::exp(fifth * x[1]);
        heater.heating_tau_s *= std::exp(fifth * (by_itself ? x[2] + x[3] : x[2]));
        heater.cooling_tau_s *= std::exp(fifth * x[3]);
        heater.ambient_degC += ambient_degC * x[4];
        return heater;
    }
};

double number_of(const HeaterParameters& heater, int i) {
    const std::array<double, heater_numbers> all{heater.onset_V, heater.gain_degC_per_V, heater.heating_tau_s,
                                                 heater.cooling_tau_s, heater.ambient_degC};
    return all[static_cast<std::size_t>(i)];
}

/// Weighted residuals of all runs, every stride-th row; rows without weight are left out.
class Residuals {
  public:
    Residuals(const std::vector<HeaterRun>& runs, const Predict& predict, const Scale& scale)
        : runs_(runs), predict_(predict), scale_(scale) {
        std::size_t all = 0;
        for (const HeaterRun& run : runs) all += run.reading.size();
        stride_ = 1 + all / most_heater_rows;
        for (const HeaterRun& run : runs)
            for (std::size_t k = 0; k < run.reading.size(); k += stride_) count_ += weight(run, k) > 0.0;
    }

    int count() const { return count_; }

    bool operator()(double const* const* blocks, double* residual) const {
        const HeaterParameters heater = scale_.at(blocks[0]);
        int next = 0;
        for (const HeaterRun& run : runs_) {
            const std::vector<double> model = predict_(heater, run);
            for (std::size_t k = 0; k < run.reading.size(); k += stride_)
                if (const double w = weight(run, k); w > 0.0)
                    residual[next++] = w * (model[k] - run.reading[k]);
        }
        return std::all_of(residual, residual + next, [](double r) { return std::isfinite(r); });
    }

    Eigen::VectorXd at(const Vector& x) const {
        Eigen::VectorXd residual(count_);
        const double* block = x.data();
        (*this)(&block, residual.data());
        return residual;
    }

    /// Residuals of each run, in their order.
    std::vector<int> run_counts() const {
        std::vector<int> counts;
        for (const HeaterRun& run : runs_) {
            counts.push_back(0);
            for (std::size_t k = 0; k < run.reading.size(); k += stride_)
                counts.back() += weight(run, k) > 0.0;
        }
        return counts;
    }

    /// Weighted squares of the readings about their weighted mean.
    double variation() const {
        double sum = 0.0, first = 0.0, second = 0.0;
        for (const HeaterRun& run : runs_)
            for (std::size_t k = 0; k < run.reading.size(); k += stride_) {
                const double w = weight(run, k) * weight(run, k);
                sum += w;
                first += w * run.reading[k];
                second += w * run.reading[k] * run.reading[k];
            }
        return sum > 0.0 ? std::max(0.0, second - first * first / sum) : 0.0;
    }

    double weight_squares() const {
        double sum = 0.0;
        for (const HeaterRun& run : runs_)
            for (std::size_t k = 0; k < run.reading.size(); k += stride_)
                sum += weight(run, k) * weight(run, k);
        return sum;
    }

  private:
    static double weight(const HeaterRun& run, std::size_t k) {
        return run.weight.empty() ? 1.0 : run.weight[k];
    }

    const std::vector<HeaterRun>& runs_;
    const Predict& predict_;
    const Scale& scale_;
    std::size_t stride_ = 1;
    int count_ = 0;
};

using Free = std::array<bool, heater_numbers>;

/// Least squares over the free numbers. @return false if it did not converge to something usable
bool solve(const Residuals& residuals, const Free& is_free, bool onset_bounded, Vector& x) {
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::DynamicNumericDiffCostFunction<Residuals, ceres::CENTRAL> cost(&residuals,
                                                                          ceres::DO_NOT_TAKE_OWNERSHIP);
    cost.AddParameterBlock(numbers);
    cost.SetNumResiduals(residuals.count());
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(&cost, nullptr, x.data());
    std::vector<int> held;
    held.reserve(heater_numbers);
    for (int i = 0; i < numbers; ++i) {
        constexpr double farthest = 30.0;
        problem.SetParameterLowerBound(x.data(), i, i == 0 && onset_bounded ? 0.0 : -farthest);
        problem.SetParameterUpperBound(x.data(), i, farthest);
        if (!is_free[static_cast<std::size_t>(i)]) held.push_back(i);
    }
    if (held.size() == heater_numbers) return true;
    if (!held.empty()) problem.SetManifold(x.data(), new ceres::SubsetManifold(numbers, held));
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-12;
    options.parameter_tolerance = 1e-10;
    options.gradient_tolerance = 1e-14;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.IsSolutionUsable() && x.allFinite();
}

/// By how much each reading moved x, a column a reading; rows of held numbers are 0.
struct HeaterInfluences {
    Eigen::Matrix<double, numbers, Eigen::Dynamic> readings;
    Eigen::Matrix<double, numbers, numbers> claimed;  ///< covariance if errors were independent
    std::vector<int> run_counts;
    std::size_t fitted = 0;
};

HeaterInfluences influences_at(const Residuals& residuals, const Free& is_free, const Vector& x) {
    constexpr double step = 1e-6;  // crosses hardly any of the kinks between the cells of the table
    constexpr double prior = 1e-8;
    Eigen::Matrix<double, Eigen::Dynamic, numbers> jacobian(residuals.count(), numbers);
    for (int i = 0; i < numbers; ++i) {
        Vector up = x, down = x;
        up(i) += step;
        down(i) -= step;
        jacobian.col(i) = (residuals.at(up) - residuals.at(down)) / (2.0 * step);
        if (!is_free[static_cast<std::size_t>(i)]) jacobian.col(i).setZero();
    }
    const Eigen::VectorXd residual = residuals.at(x);
    const double variance = std::max(residual.squaredNorm() / residuals.count(), 1e-300);
    Eigen::Matrix<double, numbers, numbers> information = jacobian.transpose() * jacobian;
    information.diagonal().array() += prior * variance;
    Eigen::Matrix<double, numbers, numbers> inverse = information.inverse();
    HeaterInfluences result{{}, {}, residuals.run_counts(), 0};
    for (int i = 0; i < numbers; ++i) {
        result.fitted += is_free[static_cast<std::size_t>(i)] ? 1 : 0;
        if (is_free[static_cast<std::size_t>(i)]) continue;
        inverse.row(i).setZero();
        inverse.col(i).setZero();
    }
    result.claimed = variance * inverse;
    result.readings = -inverse * jacobian.transpose() * residual.asDiagonal();
    return result;
}

BatchVariance variance_along(const HeaterInfluences& influences, const Vector& gradient) {
    std::vector<std::vector<double>> series;
    Eigen::Index begin = 0;
    for (const int count : influences.run_counts) {
        const Eigen::RowVectorXd along = gradient.transpose() * influences.readings.middleCols(begin, count);
        series.emplace_back(along.data(), along.data() + count);
        begin += count;
    }
    BatchVariance result = batch_variance(series, influences.fitted);
    result.variance = std::max(result.variance, gradient.dot(influences.claimed * gradient));
    return result;
}

Vector parameter_stds(const HeaterInfluences& influences) {
    Vector std;
    for (int i = 0; i < numbers; ++i)
        std(i) = std::sqrt(std::max(0.0, variance_along(influences, Vector::Unit(i)).variance));
    return std;
}

/// Derivative of a number by x.
Vector gradient_of(const Scale& scale, const Vector& x, int number) {
    constexpr double step = 1e-4;
    Vector gradient;
    for (int i = 0; i < numbers; ++i) {
        Vector up = x, down = x;
        up(i) += step;
        down(i) -= step;
        gradient(i) = (number_of(scale.at(up.data()), number) - number_of(scale.at(down.data()), number)) /
                      (2.0 * step);
    }
    return gradient;
}

struct Solution {
    HeaterFit fit;
    Vector x;
    Free is_free;
};

std::string useless(HeaterNumber number, const Scale& scale, const Vector& x, double std) {
    Vector beside = x;
    const auto i = static_cast<int>(number);
    beside(i) += 0.1;
    const double unit =
        std::abs(number_of(scale.at(beside.data()), i) - number_of(scale.at(x.data()), i)) / 0.1;
    return fmt::format("the data leave it at {:.4g} +- {:.2g}: it hardly shows, or not apart from the others",
                       number_of(scale.at(x.data()), i), unit * std);
}

/// Mean of the commands that heat.
double mean_heating_command(const std::vector<HeaterRun>& runs, const HeaterParameters& heater) {
    double sum = 0.0, count = 0.0;
    for (const HeaterRun& run : runs)
        for (const double command : run.command)
            if (command > heater.onset_V) sum += command, ++count;
    return count > 0.0 ? sum / count : heater.onset_V;
}

/// Where a number is not determined: what is, of it and of the number that it is mistaken for.
void add_combination(HeaterFit& fit, HeaterNumber number, const Scale& scale, const Vector& x,
                     const HeaterInfluences& influences, double command) {
    constexpr double fifth = 0.2;
    const HeaterParameters heater = scale.at(x.data());
    const auto gradient = [&](HeaterNumber of) { return gradient_of(scale, x, static_cast<int>(of)); };
    const auto add = [&](HeaterCombination combination, const Vector& relative) {
        const double std = std::sqrt(variance_along(influences, relative).variance);
        if (!(std < fifth) || !std::isfinite(combination.value)) return;
        combination.std = std::abs(combination.value) * std;
        fit.combinations.push_back(std::move(combination));
    };
    const Vector of_gain = gradient(HeaterNumber::gain) / heater.gain_degC_per_V;
    if (number == HeaterNumber::onset || number == HeaterNumber::gain) {
        const double above = command - heater.onset_V;
        if (above > 0.0)
            add({fmt::format("gain_times_{:.4g}_less_onset", command), "degC", heater.gain_degC_per_V * above,
                 0.0},
                of_gain - gradient(HeaterNumber::onset) / above);
    }
    if (number != HeaterNumber::onset && number != HeaterNumber::ambient)
        add({"gain_over_heating_tau", "degC/s", heater.gain_degC_per_V / heater.heating_tau_s, 0.0},
            of_gain - gradient(HeaterNumber::heating_tau) / heater.heating_tau_s);
}

/// Fits from x on, and while a standard error is useless holds the worst number at the scale's start and fits
/// again.
Result<Solution> fit_determined(const std::vector<HeaterRun>& runs, const Predict& predict,
                                const Scale& scale, Vector begin) {
    const Residuals residuals(runs, predict, scale);
    if (residuals.count() < static_cast<int>(least_rows))
        return failure(Reason::not_identifiable,
                       fmt::format("{} usable rows: {} are needed", residuals.count(), least_rows));
    Free is_free{true, true, true, true, true};
    Vector x = begin;
    HeaterFit fit{};
    fit.samples = static_cast<std::size_t>(residuals.count());
    for (;;) {
        if (!solve(residuals, is_free, scale.by_itself, x))
            return failure(Reason::no_convergence, "the heater's fit did not converge");
        const Eigen::VectorXd residual = residuals.at(x);
        if (!residual.allFinite())
            return failure(Reason::no_convergence, "the heater's fit did not converge");
        const double squares = residual.squaredNorm();
        if (scale.by_itself && is_free[0] && x(0) < 1e-6) {
            fit.refused.push_back({HeaterNumber::onset, "the heater heats from the least command on"});
            is_free[0] = false;
            begin(0) = 0.0;
            x = begin;
            continue;
        }
        fit.residual_rms = std::sqrt(squares / residuals.weight_squares());
        const double variation = residuals.variation();
        fit.missed_share = variation > 0.0 ? std::sqrt(squares / variation) : 1.0;
        const HeaterInfluences influences = influences_at(residuals, is_free, x);
        const Vector std = parameter_stds(influences);
        int worst = 0;
        if (std.maxCoeff(&worst) <= 1.0) {
            fit.heater = scale.at(x.data());
            return Solution{fit, x, is_free};
        }
        if (scale.by_itself) {
            Vector can_be_held = std;
            can_be_held(1) = can_be_held(3) = 0.0;
            if (can_be_held.maxCoeff() > 0.0) can_be_held.maxCoeff(&worst);
        }
        const auto number = static_cast<HeaterNumber>(worst);
        if (scale.by_itself && (number == HeaterNumber::gain || number == HeaterNumber::cooling_tau))
            return failure(Reason::not_identifiable,
                           fmt::format("{}: {}", name_of(number), useless(number, scale, x, std(worst))));
        add_combination(fit, number, scale, x, influences, mean_heating_command(runs, scale.at(x.data())));
        fit.refused.push_back({number, useless(number, scale, x, std(worst))});
        is_free[static_cast<std::size_t>(worst)] = false;
        begin(worst) = 0.0;
        x = begin;
    }
}

/// What each run says of the numbers by itself, from the common solution on.
using OwnNumbers = std::array<std::vector<RecordingEstimate>, heater_numbers>;
using OwnRuns = std::array<std::vector<std::size_t>, heater_numbers>;

void fit_each_run(const std::vector<HeaterRun>& runs, const Predict& predict, const Scale& scale,
                  const Solution& common, OwnNumbers& own, OwnRuns& of_run) {
    for (std::size_t r = 0; r < runs.size() && runs.size() > 1; ++r) {
        const std::vector<HeaterRun> alone{runs[r]};
        const Residuals residuals(alone, predict, scale);
        Vector x = common.x;
        if (residuals.count() < static_cast<int>(least_rows) ||
            !solve(residuals, common.is_free, scale.by_itself, x) || !residuals.at(x).allFinite())
            continue;
        const HeaterInfluences influences = influences_at(residuals, common.is_free, x);
        const Vector useful = parameter_stds(influences);
        for (int i = 0; i < numbers; ++i) {
            const BatchVariance variance = variance_along(influences, gradient_of(scale, x, i));
            const auto k = static_cast<std::size_t>(i);
            if (!common.is_free[k] || !(useful(i) <= 1.0) || !(variance.variance > 0.0)) continue;
            own[k].push_back(
                {number_of(scale.at(x.data()), i), std::sqrt(variance.variance), variance.freedom});
            of_run[k].push_back(r);
        }
    }
}

/// Standard errors of the common solution; numbers on which runs contradict each other, 1 % over all numbers,
/// and of which no common value is known to what makes it useful, are refused.
HeaterFit with_errors(const std::vector<HeaterRun>& runs, const Predict& predict, const Scale& scale,
                      const Solution& common) {
    constexpr double level = 0.01, both_tails = 0.05, normal_95 = 1.96;
    HeaterFit fit = common.fit;
    OwnNumbers own;
    OwnRuns of_run;
    fit_each_run(runs, predict, scale, common, own, of_run);
    const HeaterInfluences influences =
        influences_at(Residuals(runs, predict, scale), common.is_free, common.x);
    for (int i = 0; i < numbers; ++i) {
        const auto k = static_cast<std::size_t>(i);
        fit.std[k] = fit.freedom[k] = std::nan("");
        if (!common.is_free[k]) continue;
        const Vector gradient = gradient_of(scale, common.x, i);
        VarianceSum sum;
        const BatchVariance batches = variance_along(influences, gradient);
        sum.add(batches.variance, batches.freedom);
        const Heterogeneity scatter = heterogeneity(own[k]);
        if (scatter.added_variance > 0.0) sum.add(scatter.added_variance, scatter.added_freedom);
        fit.std[k] = std::sqrt(sum.variance);
        fit.freedom[k] = sum.freedom;
        if (own[k].size() < 2 || scatter.probability >= level / numbers) continue;
        const RecordingEstimate &low = own[k][scatter.low], &high = own[k][scatter.high];
        const auto number = static_cast<HeaterNumber>(i);
        fit.contradictions.push_back({number, scatter.apart, of_run[k][scatter.low], of_run[k][scatter.high],
                                      low.value, low.std, high.value, high.std});
        const double unit = std::abs(gradient(i));
        if (student_bound(sum.freedom, both_tails) * fit.std[k] <= normal_95 * unit) continue;
        fit.refused.push_back(
            {number, fmt::format("the recordings contradict each other by {:.1f} standard errors, {:.4g} +- "
                                 "{:.2g} and {:.4g} +- {:.2g}: no common value",
                                 scatter.apart, low.value, low.std, high.value, high.std)});
        fit.std[k] = fit.freedom[k] = std::nan("");
    }
    return fit;
}

/// The solution with the least squares from several time constants.
Vector best_of_starts(const std::vector<HeaterRun>& runs, const Scale& scale) {
    const Predict predict = predict_temperature;
    const Residuals residuals(runs, predict, scale);
    Vector best = Vector::Zero();
    if (residuals.count() == 0) return best;
    double least = std::numeric_limits<double>::infinity();
    for (const double share : {0.03, 0.1, 0.3, 1.0, 3.0}) {
        Vector x = Vector::Zero();
        x(3) = std::log(share) / 0.2;
        if (!solve(residuals, {true, true, false, true, false}, scale.by_itself, x)) continue;
        const double squares = residuals.at(x).squaredNorm();
        if (squares < least) best = x, least = squares;
    }
    return best;
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
    const Scale scale{model.heater, std::max(model.heater.limit_V - model.heater.onset_V, 1e-3)};
    Vector x = Vector::Zero();
    // A start that the data make; where it cannot be had, the model's own numbers are one too.
    if (const auto start = fit_determined(inferred_runs(model, runs), predict_temperature, scale, x))
        x = start->x;
    const Predict predict = [&](const HeaterParameters& heater, const HeaterRun& run) {
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
    const Scale scale{{.onset_V = command.low,
                       .limit_V = command.high,
                       .gain_degC_per_V = temp.size() / command.size(),
                       .heating_tau_s = 0.1 * longest_s,
                       .cooling_tau_s = 0.1 * longest_s,
                       .ambient_degC = rest_degC},
                      command.size(),
                      true};
    auto best = fit_determined(started, predict_temperature, scale, best_of_starts(started, scale));
    if (!best) return tl::make_unexpected(best.error());
    return with_errors(started, predict_temperature, scale, *best);
}

}  // namespace fidservo::calib
