// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/preisach_fit.h"

#include "calib/wire/preisach_moments.h"
#include "core/demand.h"
#include "core/failure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr std::size_t most_preisach_rows = 9000, stretches = 10;
constexpr std::array penalties{1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

/// The moments of the two alternately held-out parts, and the cells' extreme shares.
struct FoldMoments {
    std::array<PreisachMoments, 2> parts;
    std::vector<double> least, most;
    std::size_t rows = 0, stride = 1;
};

/// Calls use(k, shares) at every `stride`-th sample of [first, last), tracking the memory from 0 on.
template <class Use>
void for_each_row(const PreisachGrid& grid, std::span<const double> input, std::size_t first,
                  std::size_t last, std::size_t stride, Use use) {
    SwitchedCells cells(grid, input[0]);
    std::vector<double> shares(cell_count(grid));
    for (std::size_t k = 0; k < last; ++k) {
        cells.move(input[k]);
        if (k < first || (k - first) % stride != 0) continue;
        cells.shares(shares);
        use(k, std::span<const double>(shares));
    }
}

FoldMoments accumulate(const PreisachGrid& grid, std::span<const double> input,
                       std::span<const double> output, double direction, std::size_t first,
                       std::size_t last) {
    const std::size_t n = cell_count(grid);
    FoldMoments sums{{PreisachMoments(n), PreisachMoments(n)},
                     std::vector<double>(n, 1.0),
                     std::vector<double>(n, 0.0),
                     0,
                     1 + (last - first) / most_preisach_rows};
    for_each_row(grid, input, first, last, sums.stride, [&](std::size_t k, std::span<const double> shares) {
        const std::size_t stretch = (k - first) * stretches / (last - first);
        sums.parts[stretch % 2].add(shares, direction * output[k]);
        ++sums.rows;
        for (std::size_t i = 0; i < n; ++i) {
            sums.least[i] = std::min(sums.least[i], shares[i]);
            sums.most[i] = std::max(sums.most[i], shares[i]);
        }
    });
    return sums;
}

struct Choice {
    double penalty, held_out_rms;
};

Choice choose_penalty(const FoldMoments& sums, std::span<const double> rough) {
    Choice best{penalties.back(), std::numeric_limits<double>::infinity()};
    for (const double penalty : penalties) {
        double squares = 0.0, count = 0.0;
        for (std::size_t held = 0; held < 2; ++held) {
            const PreisachMoments& train = sums.parts[1 - held];
            const auto weights = fit_density(train, rough, penalty);
            if (!weights) {
                squares = std::numeric_limits<double>::infinity();
                break;
            }
            squares += sums.parts[held].squares(*weights, train.offset(*weights));
            count += sums.parts[held].samples();
        }
        const double rms = std::sqrt(std::max(squares, 0.0) / count);
        if (rms < best.held_out_rms) best = {penalty, rms};
    }
    return best;
}

}  // namespace

Result<PreisachFit> fit_preisach(const HysteresisTrace& trace, const PreisachFitOptions& options) {
    if (const Status checked = check_hysteresis_trace(trace, options.nodes); !checked)
        return tl::make_unexpected(checked.error());
    const double least_reversal = options.least_reversal.value_or(noise_reversal(trace.input));
    const std::vector<double> input = without_small_reversals(trace.input, least_reversal);
    const std::size_t known = options.starts_at_saturation ? 0 : first_known_memory(input);
    const std::size_t first = std::max(options.first, known), last = std::min(options.last, input.size());
    if (first >= last || last - first < least_hysteresis_samples)
        return failure(Reason::not_identifiable,
                       "the input reaches an end of its range, after which its memory is known, too late");

    const auto [lowest, highest] = std::minmax_element(input.begin(), input.end());
    const double low = options.low.value_or(*lowest), high = options.high.value_or(*highest);
    if (!(low < high))
        return failure(Reason::not_identifiable, "the grid's lower end is not below its upper end");
    const PreisachGrid grid{low, (high - low) / static_cast<double>(options.nodes - 1), options.nodes};
    const double direction = direction_of(trace);
    const FoldMoments sums = accumulate(grid, input, trace.output, direction, first, last);
    const std::vector<double> rough = roughness(grid);
    const Choice choice = choose_penalty(sums, rough);
    PreisachMoments all = sums.parts[0];
    all.add(sums.parts[1]);
    const auto weights = fit_density(all, rough, choice.penalty);
    if (!weights) return tl::make_unexpected(weights.error());

    PreisachFit fit{table_of_density(grid, *weights),
                    direction * all.offset(*weights),
                    direction,
                    {},
                    {},
                    choice.penalty,
                    0.0,
                    choice.held_out_rms,
                    1.0,
                    sums.rows,
                    least_reversal};
    const std::vector<double> model = predict(fit, trace.input);
    std::vector<double> residual;
    residual.reserve(sums.rows);
    for (std::size_t k = first; k < last; k += sums.stride) residual.push_back(trace.output[k] - model[k]);
    double squares = 0.0;
    for (const double r : residual) squares += r * r;
    fit.residual_rms = std::sqrt(squares / static_cast<double>(residual.size()));
    fit.correlation_samples = correlation_length(residual);
    fit.node_std = node_standard_errors(grid, all, *weights,
                                        fit.held_out_rms * fit.held_out_rms * fit.correlation_samples);
    fit.determined = determined_nodes(grid, sums.least, sums.most, fit.node_std, fit.table.stroke_mm());
    return fit;
}

std::vector<double> predict(const PreisachFit& fit, std::span<const double> input) {
    std::vector<double> output;
    if (input.empty()) return output;
    const std::vector<double> smooth = without_small_reversals(input, fit.least_reversal);
    output.reserve(smooth.size());
    PreisachMemory memory = preisach_start(fit.table, smooth[0]);
    for (const double value : smooth)
        output.push_back(fit.offset + fit.direction * preisach_step(fit.table, memory, value));
    return output;
}

double prediction_rms(const PreisachFit& fit, const HysteresisTrace& trace, std::size_t first,
                      std::size_t last) {
    const std::vector<double> model = predict(fit, trace.input);
    last = std::min(last, model.size());
    FIDSERVO_DEMAND(first < last);
    double squares = 0.0;
    for (std::size_t k = first; k < last; ++k) squares += std::pow(model[k] - trace.output[k], 2);
    return std::sqrt(squares / static_cast<double>(last - first));
}

}  // namespace fidservo::calib
