// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/heater_errors.h"

#include "calib/heterogeneity.h"
#include "calib/tails.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::calib {

namespace {

/// What each run says of the numbers by itself, from the common solution on.
using OwnNumbers = std::array<std::vector<RecordingEstimate>, heater_numbers>;
using OwnRuns = std::array<std::vector<std::size_t>, heater_numbers>;

void fit_each_run(const std::vector<HeaterRun>& runs, const HeaterPredict& predict, const HeaterScale& scale,
                  const HeaterSolution& common, OwnNumbers& own, OwnRuns& of_run) {
    for (std::size_t r = 0; r < runs.size() && runs.size() > 1; ++r) {
        const std::vector<HeaterRun> alone{runs[r]};
        const HeaterResiduals residuals(alone, predict, scale);
        HeaterVector x = common.x;
        if (residuals.count() < static_cast<int>(least_heater_rows) ||
            !solve_heater(residuals, common.is_free, scale.by_itself, x) || !residuals.at(x).allFinite())
            continue;
        const HeaterInfluences influences = influences_at(residuals, common.is_free, x);
        const HeaterVector useful = parameter_stds(influences);
        for (int i = 0; i < heater_count; ++i) {
            const BatchVariance variance = variance_along(influences, gradient_of(scale, x, i));
            const auto k = static_cast<std::size_t>(i);
            if (!common.is_free[k] || !(useful(i) <= 1.0) || !(variance.variance > 0.0)) continue;
            own[k].push_back(
                {number_of(scale.at(x.data()), i), std::sqrt(variance.variance), variance.freedom});
            of_run[k].push_back(r);
        }
    }
}

/// Whether runs differ on some number, at 5 % each: a model that is common to them is then wrong on the
/// others too, and each number is the mean of what the runs say by themselves.
bool runs_differ(const OwnNumbers& own) {
    constexpr double each = 0.05;
    return std::ranges::any_of(own, [&](const std::vector<RecordingEstimate>& of_number) {
        return of_number.size() > 1 && heterogeneity(of_number).probability < each;
    });
}

void set_number(HeaterParameters& heater, int i, double value) {
    const std::array<double*, heater_numbers> all{&heater.onset_V, &heater.gain_degC_per_V,
                                                  &heater.heating_tau_s, &heater.cooling_tau_s,
                                                  &heater.ambient_degC};
    *all[static_cast<std::size_t>(i)] = value;
}

bool is_refused(const HeaterFit& fit, int i) {
    return std::ranges::any_of(
        fit.refused, [&](const HeaterRefusal& refusal) { return static_cast<int>(refusal.number) == i; });
}

/// How many times farther than its standard error says a figure may lie, on the side that is the wider one:
/// the profile of the squares, everything else fitted again at each value, at four standard errors over what
/// it would be of a parabola; from 1 to 100, beyond which no end is looked for.
/// @param gradient  of the figure by x
double widening(HeaterResiduals residuals, const HeaterVector& x, const HeaterFree& is_free,
                const HeaterInfluences& influences, const HeaterVector& gradient,
                const std::function<double(const HeaterVector&)>& figure) {
    constexpr double far = 4.0, farthest = 100.0, step = 1.5, tight = 1e-3;
    const double claimed = gradient.dot(influences.claimed * gradient);
    const double variance = variance_along(influences, gradient).variance, std = std::sqrt(variance);
    const int rows = residuals.count();
    const double here = residuals.at(x).squaredNorm(), noise = here / rows, value = figure(x);
    if (!(claimed > 0.0) || !(noise > 0.0) || !std::isfinite(value)) return 1.0;
    const double rise_at_end = far * far * variance / claimed * noise;
    double widest = 1.0;
    for (const double side : {+1.0, -1.0}) {
        double below = 0.0, root_below = 0.0, end = farthest;
        HeaterVector at = x;
        for (double share = 1.0; share < farthest; share *= step) {
            residuals.pin({figure, value + side * share * far * std, tight * std / std::sqrt(noise)});
            if (!solve_heater(residuals, is_free, true, at)) break;
            const double rise = residuals.at(at).head(rows).squaredNorm() - here;
            const bool arrived = std::abs(figure(at) - value) > 0.9 * share * far * std;
            const double root = arrived ? std::sqrt(std::max(0.0, rise / rise_at_end)) : 1.0 + root_below;
            if (root >= 1.0) {
                end = below + (share - below) * (1.0 - root_below) / (root - root_below);
                break;
            }
            below = share;
            root_below = root;
        }
        widest = std::max(widest, end);
    }
    return widest;
}

/// Of what has this gradient, in the solution and in the one that had the held numbers free.
BatchVariance variance_with_held(const HeaterSolution& common, const HeaterInfluences& influences,
                                 const HeaterVector& gradient) {
    BatchVariance variance = variance_along(influences, gradient);
    for (const HeaterVector& moved : common.moved_by_starts)
        variance.variance += std::pow(gradient.dot(moved), 2);
    if (!common.freer) return variance;
    const BatchVariance before = variance_along(common.freer->influences, gradient);
    if (before.variance > variance.variance) variance = before;
    variance.variance += std::pow(gradient.dot(common.freer->x - common.x), 2);
    return variance;
}

/// The standard error of a number of one recording, made wider where the squares are no parabola; refused
/// where it is useless then.
void widen_or_refuse(const std::vector<HeaterRun>& runs, const HeaterPredict& predict,
                     const HeaterScale& scale, const HeaterSolution& common, int number, HeaterFit& fit) {
    const auto k = static_cast<std::size_t>(number);
    const HeaterResiduals residuals(runs, predict, scale);
    const HeaterVector x = common.freer ? common.freer->x : common.x;
    const HeaterFree is_free = common.freer ? HeaterFree{true, true, true, true, true} : common.is_free;
    const HeaterVector gradient = gradient_of(scale, x, number);
    const HeaterInfluences influences =
        common.freer ? common.freer->influences : influences_at(residuals, is_free, x);
    const double wider = widening(residuals, x, is_free, influences, gradient, [&](const HeaterVector& at) {
        return number_of(scale.at(at.data()), number);
    });
    fit.std[k] *= wider;
    if (fit.std[k] <= std::abs(gradient(number))) return;
    fit.refused.push_back(
        {static_cast<HeaterNumber>(number),
         fmt::format("the data leave it at {:.4g} with a standard error of {:.2g}: it hardly "
                     "shows, or not apart from the others",
                     number_of(scale.at(common.x.data()), number), fit.std[k])});
    fit.std[k] = fit.freedom[k] = std::nan("");
}

}  // namespace

void refuse_what_hangs_on_others(HeaterSolution& solution) {
    if (!solution.freer) return;
    std::string held;
    for (const HeaterRefusal& refusal : solution.fit.refused)
        held += (held.empty() ? "" : ", ") + std::string(name_of(refusal.number));
    const HeaterVector std = parameter_stds(solution.freer->influences);
    for (int i = 0; i < heater_count; ++i) {
        if (!solution.is_free[static_cast<std::size_t>(i)] || std(i) <= 1.0) continue;
        const auto number = static_cast<HeaterNumber>(i);
        solution.fit.refused.push_back(
            {number, fmt::format("it is not determined apart from {}, which the data leave open", held)});
    }
}

HeaterFit with_errors(const std::vector<HeaterRun>& runs, const HeaterPredict& predict,
                      const HeaterScale& scale, const HeaterSolution& common) {
    constexpr double level = 0.01;
    HeaterFit fit = common.fit;
    OwnNumbers own;
    OwnRuns of_run;
    fit_each_run(runs, predict, scale, common, own, of_run);
    const bool differ = runs_differ(own);
    const HeaterInfluences influences =
        influences_at(HeaterResiduals(runs, predict, scale), common.is_free, common.x);
    for (int i = 0; i < heater_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        fit.std[k] = fit.freedom[k] = std::nan("");
        if (!common.is_free[k]) continue;
        const HeaterVector gradient = gradient_of(scale, common.x, i);
        VarianceSum sum;
        const BatchVariance batches = variance_with_held(common, influences, gradient);
        sum.add(batches.variance, batches.freedom);
        const Heterogeneity scatter = heterogeneity(own[k]);
        if (scatter.added_variance > 0.0) sum.add(scatter.added_variance, scatter.added_freedom);
        if (differ && own[k].size() > 1) {
            set_number(fit.heater, i, scatter.mean);
            sum = {};
            sum.add(scatter.mean_variance, scatter.added_freedom);
        }
        const bool refused = is_refused(common.fit, i);
        if (!refused) {
            fit.std[k] = std::sqrt(sum.variance);
            fit.freedom[k] = sum.freedom;
        }
        if (!refused && scale.by_itself && runs.size() == 1)
            widen_or_refuse(runs, predict, scale, common, i, fit);
        if (own[k].size() < 2 || scatter.probability >= level / heater_count) continue;
        const RecordingEstimate &low = own[k][scatter.low], &high = own[k][scatter.high];
        const auto number = static_cast<HeaterNumber>(i);
        fit.contradictions.push_back({number, scatter.apart, of_run[k][scatter.low], of_run[k][scatter.high],
                                      low.value, low.std, high.value, high.std});
        if (refused) continue;
        const double unit = std::abs(gradient(i));
        if (student_95(sum.freedom) * fit.std[k] <= normal_95 * unit) continue;
        fit.refused.push_back(
            {number, fmt::format("the recordings contradict each other by {:.1f} standard errors, {:.4g} +- "
                                 "{:.2g} and {:.4g} +- {:.2g}: no common value",
                                 scatter.apart, low.value, low.std, high.value, high.std)});
        fit.std[k] = fit.freedom[k] = std::nan("");
    }
    return fit;
}

double mean_heating_command(const std::vector<HeaterRun>& runs, const HeaterParameters& heater) {
    double sum = 0.0, count = 0.0;
    for (const HeaterRun& run : runs)
        for (const double command : run.command)
            if (command > heater.onset_V) sum += command, ++count;
    return count > 0.0 ? sum / count : heater.onset_V;
}

void add_combination(HeaterFit& fit, HeaterNumber number, const HeaterResiduals& residuals,
                     const HeaterScale& scale, const HeaterVector& x, const HeaterInfluences& influences,
                     double command) {
    constexpr double fifth = 0.2;
    const HeaterParameters heater = scale.at(x.data());
    const auto gradient = [&](HeaterNumber of) { return gradient_of(scale, x, static_cast<int>(of)); };
    const auto add = [&](HeaterCombination combination, const HeaterVector& relative,
                         const std::function<double(const HeaterParameters&)>& figure) {
        double std = std::sqrt(variance_along(influences, relative).variance);
        if (!(std < fifth)) return;
        if (scale.by_itself)
            std *= widening(
                residuals, x, {true, true, true, true, true}, influences, relative,
                [&](const HeaterVector& at) { return figure(scale.at(at.data())) / combination.value; });
        if (!(std < fifth) || !std::isfinite(combination.value)) return;
        combination.std = std::abs(combination.value) * std;
        fit.combinations.push_back(std::move(combination));
    };
    const HeaterVector of_gain = gradient(HeaterNumber::gain) / heater.gain_degC_per_V;
    if (number == HeaterNumber::onset || number == HeaterNumber::gain) {
        const double above = command - heater.onset_V;
        if (above > 0.0)
            add({fmt::format("gain_times_{:.4g}_less_onset", command), "degC", heater.gain_degC_per_V * above,
                 0.0},
                of_gain - gradient(HeaterNumber::onset) / above,
                [=](const HeaterParameters& at) { return at.gain_degC_per_V * (command - at.onset_V); });
    }
    if (number != HeaterNumber::onset && number != HeaterNumber::ambient)
        add({"gain_over_heating_tau", "degC/s", heater.gain_degC_per_V / heater.heating_tau_s, 0.0},
            of_gain - gradient(HeaterNumber::heating_tau) / heater.heating_tau_s,
            [](const HeaterParameters& at) { return at.gain_degC_per_V / at.heating_tau_s; });
}

}  // namespace fidservo::calib
