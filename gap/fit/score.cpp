// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/fit/score.h"

#include "calib/significance.h"
#include "gap/numbers.h"

#include <cmath>
#include <limits>

namespace fidservo::gap {
namespace {

/// Windows in a block: errors of neighbouring windows are correlated through slow states, those of
/// neighbouring frames are not (gap/links/image_link.h).
std::size_t windows_in_block(Signal signal) {
    return signal == Signal::image ? 1 : windows_in_correlation;
}

constexpr int fewest_blocks = 4;

/// Mathematics: the t with P(T > t) = tail, T being Student-distributed: Fisher's expansion (Abramowitz and
/// Stegun, Handbook of Mathematical Functions, 1964, 26.7.5). For tails down to 1e-4 it is some per cent low
/// at 4 degrees of freedom, and by 1e-3 from 10 on.
double student_bound(double freedom, double tail) {
    const double z = calib::normal_bound(tail), z2 = z * z;
    const double first = z * (z2 + 1.0) / 4.0;
    const double second = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
    const double third = z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
    const double fourth = z * ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
    return z + (first + (second + (third + fourth / freedom) / freedom) / freedom) / freedom;
}

/// NaN where no value counts.
double mean_square(const Window& window, const Errors& errors) {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = window.begin; k < window.end; ++k) {
        const double error = errors[k];
        if (std::isnan(error)) continue;
        sum += error * error;
        count += 1.0;
    }
    return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<double> mean_squares(std::span<const Window> windows, const Errors& errors) {
    if (errors.empty()) return std::vector(windows.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<double> means;
    means.reserve(windows.size());
    for (const Window& window : windows) means.push_back(mean_square(window, errors));
    return means;
}

double window_loss(double mean_square) {
    return 0.5 * std::log1p(mean_square);
}

double total_loss(std::span<const double> mean_squares) {
    double loss = 0.0;
    for (const double mean_square : mean_squares)
        if (!std::isnan(mean_square)) loss += window_loss(mean_square);
    return loss;
}

double total_loss(std::span<const Window> windows, const Wanted& counted, const Errors& errors) {
    if (errors.empty()) return std::numeric_limits<double>::infinity();
    double loss = 0.0;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        if (counted[w] == 0) continue;
        const double square = mean_square(windows[w], errors);
        if (!std::isnan(square)) loss += window_loss(square);
    }
    return loss;
}

double gained(std::span<const Window> windows, const Wanted& counted, std::span<const double> base_squares,
              const Errors& errors) {
    if (errors.empty()) return -std::numeric_limits<double>::infinity();
    std::vector<double> squares(windows.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (counted[w] != 0) squares[w] = mean_square(windows[w], errors);
    return gained(counted, base_squares, squares);
}

double gained(const Wanted& counted, std::span<const double> base_squares, std::span<const double> squares) {
    double gain = 0.0;
    for (std::size_t w = 0; w < squares.size(); ++w)
        if (counted[w] != 0 && !std::isnan(base_squares[w]) && !std::isnan(squares[w]))
            gain += window_loss(base_squares[w]) - window_loss(squares[w]);
    return gain;
}

Comparison compare(std::span<const Window> windows, std::span<const double> first,
                   std::span<const double> second) {
    Comparison result;
    std::vector<double> gains;
    std::size_t in_block = 0;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const bool goes_on = w > 0 && windows[w].run == windows[w - 1].run &&
                             windows[w].signal == windows[w - 1].signal &&
                             in_block < windows_in_block(windows[w].signal);
        if (!goes_on) in_block = 0;
        if (in_block++ == 0) gains.push_back(0.0);
        if (std::isnan(first[w]) || std::isnan(second[w])) continue;
        gains.back() += window_loss(first[w]) - window_loss(second[w]);
    }
    double squares = 0.0;
    for (const double gain : gains) {
        result.gain += gain;
        squares += gain * gain;
        result.blocks += gain != 0.0 ? 1 : 0;
    }
    if (result.blocks < 2) return result;
    const double n = result.blocks, mean = result.gain / n;
    const double variance = (squares - n * mean * mean) / (n - 1.0);
    result.significance = result.gain / std::sqrt(std::max(n * variance, least_positive));
    return result;
}

double significance_bound(int blocks, int trials, double tail) {
    if (blocks < fewest_blocks) return std::numeric_limits<double>::infinity();
    return student_bound(blocks - 1.0, tail / trials);
}

}  // namespace fidservo::gap
