// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/fod_curves.h"

#include "core/failure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr double cold_share = 0.03;  ///< of the range: this near to the cold end the memory is wiped out
constexpr std::size_t least_in_window = 4;

double cold_limit(const PreisachGrid& grid) {
    return grid.low + cold_share * grid.step * static_cast<double>(grid.nodes - 1);
}

struct Branch {
    std::size_t first, last;  ///< samples, [first, last]
    bool rises;
};

std::vector<Branch> branches_of(std::span<const double> input) {
    std::vector<Branch> branches;
    branches.reserve(16);
    for (std::size_t k = 1; k < input.size(); ++k) {
        if (input[k] == input[k - 1]) continue;
        const bool rises = input[k] > input[k - 1];
        if (branches.empty() || branches.back().rises != rises) branches.push_back({k - 1, k, rises});
        branches.back().last = k;
    }
    return branches;
}

/// A straight line through samples, read at `at`.
class LocalLine {
  public:
    void add(double input, double output) {
        count_ += 1.0;
        in_ += input;
        out_ += output;
        in_in_ += input * input;
        in_out_ += input * output;
        out_out_ += output * output;
        low_ = std::min(low_, input);
        high_ = std::max(high_, input);
    }

    std::size_t count() const { return static_cast<std::size_t>(count_); }
    /// Whether samples lie on both sides, or the line need not be drawn out far.
    bool reaches(double at, double slack) const { return low_ - slack <= at && at <= high_ + slack; }

    /// Steps of the encoder are errors that neighbouring samples share: one per step travelled is new. The
    /// rest of the scatter is the curve's bend, which the line does not follow.
    FodReading read(double at, double step) const {
        const double mean_in = in_ / count_, mean_out = out_ / count_;
        const double spread = in_in_ / count_ - mean_in * mean_in;
        const double slope = spread > 0.0 ? (in_out_ / count_ - mean_in * mean_out) / spread : 0.0;
        const double travel = std::abs(slope) * (high_ - low_), rounding = step * step / 12.0;
        const double scatter = out_out_ / count_ - mean_out * mean_out - slope * slope * spread;
        const double independent = std::clamp(step > 0.0 ? travel / step : count_, 1.0, count_);
        const double away = spread > 0.0 ? (at - mean_in) * (at - mean_in) / spread : 0.0;
        const double variance = std::max(0.0, scatter - rounding) + rounding / independent;
        return {at, mean_out + slope * (at - mean_in), std::sqrt(variance * (1.0 + away))};
    }

  private:
    double count_ = 0.0, in_ = 0.0, out_ = 0.0, in_in_ = 0.0, in_out_ = 0.0, out_out_ = 0.0;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

/// Reads branches at the nodes; samples of several branches that show the same curve are taken together.
std::vector<FodReading> read_at_nodes(const PreisachGrid& grid, const HysteresisTrace& trace,
                                      std::span<const Branch> branches, double step) {
    std::vector<LocalLine> lines(grid.nodes);
    for (const Branch& branch : branches)
        for (std::size_t k = branch.first; k <= branch.last; ++k) {
            const double place = (trace.input[k] - grid.low) / grid.step;
            const double node = std::round(place);
            if (node < 0.0 || node > static_cast<double>(grid.nodes - 1)) continue;
            lines[static_cast<std::size_t>(node)].add(trace.input[k], trace.output[k]);
        }
    std::vector<FodReading> readings;
    readings.reserve(grid.nodes);
    for (std::size_t i = 0; i < grid.nodes; ++i)
        if (lines[i].count() >= least_in_window && lines[i].reaches(node_of(grid, i), 0.1 * grid.step))
            readings.push_back(lines[i].read(node_of(grid, i), step));
    return readings;
}

struct Curves {
    FodCurve ascending;
    std::vector<FodCurve> descending;
    std::size_t left_out = 0;
};

Curves read_curves(const PreisachGrid& grid, const HysteresisTrace& trace, double step) {
    const std::span<const double> input(trace.input);
    const double cold = cold_limit(grid);
    const std::vector<Branch> branches = branches_of(input);
    Curves curves;
    std::vector<Branch> ascents;
    ascents.reserve(branches.size());
    for (std::size_t i = 0; i < branches.size(); ++i) {
        const Branch& up = branches[i];
        if (!up.rises) continue;
        if (input[up.first] > cold) {
            ++curves.left_out;
            continue;
        }
        ascents.push_back(up);
        if (i + 1 == branches.size()) continue;
        const Branch& down = branches[i + 1];
        const double peak = *std::max_element(input.begin() + static_cast<std::ptrdiff_t>(up.first),
                                              input.begin() + static_cast<std::ptrdiff_t>(down.last));
        curves.descending.push_back({peak, read_at_nodes(grid, trace, std::span(&down, 1), step)});
        curves.ascending.peak = std::max(curves.ascending.peak, peak);
    }
    curves.ascending.readings = read_at_nodes(grid, trace, ascents, step);
    std::sort(curves.descending.begin(), curves.descending.end(),
              [](const FodCurve& a, const FodCurve& b) { return a.peak > b.peak; });
    return curves;
}

/// R.m.s. of table minus readings.
double disagreement(const PreisachFit& fit, const Curves& curves) {
    double squares = 0.0, count = 0.0;
    const auto add = [&](double peak, const FodReading& reading) {
        const double model = fit.offset + fit.direction * fit.table.contraction_mm(peak, reading.temp);
        squares += (model - reading.output) * (model - reading.output);
        count += 1.0;
    };
    for (const FodReading& reading : curves.ascending.readings) add(reading.temp, reading);
    for (const FodCurve& curve : curves.descending)
        for (const FodReading& reading : curve.readings) add(curve.peak, reading);
    return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

}  // namespace

Result<FodIdentification> identify_fod(const HysteresisTrace& trace, const FodOptions& options) {
    if (const Status checked = check_hysteresis_trace(trace, options.nodes); !checked)
        return tl::make_unexpected(checked.error());
    const auto [low, high] = std::minmax_element(trace.input.begin(), trace.input.end());
    const PreisachGrid grid{*low, (*high - *low) / static_cast<double>(options.nodes - 1), options.nodes};
    const double least_reversal = options.least_reversal.value_or(noise_reversal(trace.input));
    const HysteresisTrace course{without_small_reversals(trace.input, least_reversal), trace.output};
    const double step = options.output_step.value_or(smallest_step(trace.output));
    Curves curves = read_curves(grid, course, step);
    if (curves.descending.size() < 2 ||
        curves.descending.front().peak - curves.descending.back().peak < grid.step)
        return failure(
            Reason::not_identifiable,
            fmt::format("{} cooling curves from the cold end's cycles: two of different peak are needed",
                        curves.descending.size()));
    auto fit = fit_preisach(trace, {.nodes = options.nodes,
                                    .starts_at_saturation = course.input.front() <= cold_limit(grid),
                                    .least_reversal = least_reversal});
    if (!fit) return tl::make_unexpected(fit.error());
    const double misfit = disagreement(*fit, curves);
    return FodIdentification{std::move(curves.ascending), std::move(curves.descending), std::move(*fit),
                             misfit, curves.left_out};
}

}  // namespace fidservo::calib
