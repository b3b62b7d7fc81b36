// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/preisach_data.h"

#include "core/failure.h"
#include "core/median.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr std::size_t fewest_nodes = 3, most_nodes = 80;
constexpr double range_share = 0.01;  ///< this near to the end of its range an input counts as there
constexpr double largest = 1e100;     ///< beyond, squares overflow

struct InputRange {
    double low, high;
};

InputRange range_of(std::span<const double> values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return {*low, *high};
}

bool all_usable(std::span<const double> values) {
    return std::all_of(values.begin(), values.end(),
                       [](double value) { return std::isfinite(value) && std::abs(value) < largest; });
}

bool moves(const InputRange& range) {
    return range.high - range.low > 1e-9 * std::max(std::abs(range.low), std::abs(range.high));
}

/// The first and last sample, and the extremes between which the input reverses by at least a size.
std::vector<std::size_t> turns_of(std::span<const double> input, double least_reversal) {
    std::vector<std::size_t> turns;
    if (input.empty()) return turns;
    turns.reserve(16);
    turns.push_back(0);
    std::size_t highest = 0, lowest = 0;  // since the last turn
    int heading = 0;                      // +1 rising, -1 falling, 0 not known yet
    for (std::size_t k = 1; k < input.size(); ++k) {
        if (input[k] >= input[highest]) highest = k;
        if (input[k] <= input[lowest]) lowest = k;
        const bool has_fallen = input[highest] - input[k] > least_reversal;
        const bool has_risen = input[k] - input[lowest] > least_reversal;
        if (heading >= 0 && has_fallen) {
            if (highest > turns.back()) turns.push_back(highest);
            heading = -1;
            lowest = k;
        } else if (heading <= 0 && has_risen) {
            if (lowest > turns.back()) turns.push_back(lowest);
            heading = 1;
            highest = k;
        }
    }
    if (turns.back() + 1 < input.size()) turns.push_back(input.size() - 1);
    return turns;
}

/// Pools neighbours that are out of order until none are: the nearest monotone values in least squares.
void make_monotone(std::span<double> values, bool rises) {
    struct Pool {
        double mean;
        std::size_t count;
    };
    std::vector<Pool> pools;
    pools.reserve(values.size());
    for (const double value : values) {
        pools.push_back({value, 1});
        while (pools.size() > 1) {
            const Pool& last = pools.back();
            Pool& before = pools[pools.size() - 2];
            if (rises ? before.mean <= last.mean : before.mean >= last.mean) break;
            const std::size_t count = before.count + last.count;
            before.mean +=
                (last.mean - before.mean) * static_cast<double>(last.count) / static_cast<double>(count);
            before.count = count;
            pools.pop_back();
        }
    }
    std::size_t next = 0;
    for (const Pool& pool : pools)
        for (std::size_t i = 0; i < pool.count; ++i) values[next++] = pool.mean;
}

}  // namespace

Status check_hysteresis_trace(const HysteresisTrace& trace, std::size_t nodes) {
    const auto refuse = [](std::string text) { return failure(Reason::not_identifiable, std::move(text)); };
    if (trace.input.size() != trace.output.size())
        return refuse(fmt::format("{} inputs, {} outputs: as many are needed", trace.input.size(),
                                  trace.output.size()));
    if (trace.input.size() < least_hysteresis_samples)
        return refuse(
            fmt::format("{} samples: at least {} are needed", trace.input.size(), least_hysteresis_samples));
    if (!all_usable(trace.input) || !all_usable(trace.output))
        return refuse("the data hold values that are not usable numbers");
    if (nodes < fewest_nodes || nodes > most_nodes)
        return refuse(fmt::format("{} nodes: {} to {} are possible", nodes, fewest_nodes, most_nodes));
    if (!moves(range_of(trace.input))) return refuse("the input does not move");
    if (!moves(range_of(trace.output))) return refuse("the output does not move");
    return {};
}

double direction_of(const HysteresisTrace& trace) {
    double in = 0.0, out = 0.0, product = 0.0;
    const auto n = static_cast<double>(trace.input.size());
    for (std::size_t k = 0; k < trace.input.size(); ++k) in += trace.input[k] / n, out += trace.output[k] / n;
    for (std::size_t k = 0; k < trace.input.size(); ++k)
        product += (trace.input[k] - in) * (trace.output[k] - out);
    return product < 0.0 ? -1.0 : 1.0;
}

std::vector<double> without_small_reversals(std::span<const double> input, double least_reversal) {
    std::vector<double> course(input.begin(), input.end());
    const std::vector<std::size_t> turns = turns_of(input, least_reversal);
    for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
        const bool rises = input[turns[i + 1]] > input[turns[i]];
        make_monotone(std::span(course).subspan(turns[i], turns[i + 1] - turns[i] + 1), rises);
    }
    return course;
}

double noise_reversal(std::span<const double> input) {
    constexpr double normal_per_median = 1.4826, difference_gain = 8.3666002653407556;  // sqrt(70)
    constexpr double standard_deviations = 8.0;
    if (input.size() < 5) return 0.0;
    std::vector<double> size;
    size.reserve(input.size() - 4);
    for (std::size_t k = 4; k < input.size(); ++k)
        size.push_back(
            std::abs(input[k] - 4.0 * input[k - 1] + 6.0 * input[k - 2] - 4.0 * input[k - 3] + input[k - 4]));
    return standard_deviations * normal_per_median * median_of(std::move(size)) / difference_gain +
           smallest_step(input);
}

double smallest_step(std::span<const double> values) {
    if (values.empty()) return 0.0;
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const double range = sorted.back() - sorted.front();
    double step = range;
    for (std::size_t k = 1; k < sorted.size(); ++k) {
        const double difference = sorted[k] - sorted[k - 1];
        if (difference > 1e-6 * range) step = std::min(step, difference);
    }
    return step;
}

std::size_t first_known_memory(std::span<const double> input) {
    if (input.empty()) return 0;
    const InputRange range = range_of(input);
    const double near = range_share * (range.high - range.low);
    const auto found = std::find_if(input.begin(), input.end(), [&](double value) {
        return value <= range.low + near || value >= range.high - near;
    });
    return static_cast<std::size_t>(found - input.begin());
}

double correlation_length(std::span<const double> residual) {
    double variance = 0.0;
    for (const double r : residual) variance += r * r;
    double length = 1.0;
    for (std::size_t lag = 1; variance > 0.0 && lag < residual.size() / 4; ++lag) {
        double sum = 0.0;
        for (std::size_t k = lag; k < residual.size(); ++k) sum += residual[k] * residual[k - lag];
        if (sum < 0.05 * variance) break;
        length += 2.0 * sum / variance;
    }
    return length;
}

}  // namespace fidservo::calib
