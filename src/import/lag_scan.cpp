// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/lag_scan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <opencv2/core.hpp>

namespace fidservo::imports {
namespace {

/// sums[k]: of the first k values and of their squares.
struct RunningSums {
    explicit RunningSums(const std::vector<double>& values) : sum(1, 0.0), square(1, 0.0) {
        for (const double value : values) {
            sum.push_back(sum.back() + value);
            square.push_back(square.back() + value * value);
        }
    }
    std::vector<double> sum, square;
};

/// Of y[i] with x[i + lag], summed, for every lag: element (lag + size) % size.
std::vector<double> products_by_lag(const std::vector<double>& y, const std::vector<double>& x) {
    const int size = cv::getOptimalDFTSize(static_cast<int>(x.size() + y.size()));
    const auto spectrum = [&](const std::vector<double>& values) {
        cv::Mat padded = cv::Mat::zeros(1, size, CV_64F), out;
        std::ranges::copy(values, padded.ptr<double>());
        cv::dft(padded, out);
        return out;
    };
    cv::Mat product, back;
    cv::mulSpectrums(spectrum(x), spectrum(y), product, 0, true);
    cv::dft(product, back, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
    return {back.ptr<double>(), back.ptr<double>() + size};
}

double height_at(const LagScan& scan, std::size_t k) {
    return std::abs(scan.correlation[k]);
}

/// Stretches of lags above a level that sinks, each of which belongs to the highest maximum in it.
class Hills {
  public:
    explicit Hills(std::size_t lags) : hill_of_(lags, none) {}

    bool is_above(std::size_t k) const { return hill_of_[k] != none; }
    void begin_at(std::size_t k) { hill_of_[k] = k; }
    void add(std::size_t k, std::size_t neighbour) { hill_of_[k] = top_of(neighbour); }
    void join(std::size_t lower, std::size_t higher) { hill_of_[lower] = higher; }

    std::size_t top_of(std::size_t k) {
        while (hill_of_[k] != k) k = hill_of_[k] = hill_of_[hill_of_[k]];
        return k;
    }

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> hill_of_;
};

}  // namespace

LagScan scan_lags(const std::vector<double>& y, const std::vector<double>& x) {
    const auto nx = static_cast<std::ptrdiff_t>(x.size()), ny = static_cast<std::ptrdiff_t>(y.size());
    const std::ptrdiff_t least = std::min(nx, ny) / 2;
    const std::vector<double> products = products_by_lag(y, x);
    const RunningSums of_x(x), of_y(y);
    LagScan scan{least - ny, least, {}};
    for (std::ptrdiff_t lag = scan.first; lag <= nx - least; ++lag) {
        const auto x0 = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, lag));
        const auto x1 = static_cast<std::size_t>(std::min(nx, lag + ny));
        const auto y0 = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, -lag)), y1 = y0 + (x1 - x0);
        const double n = static_cast<double>(x1 - x0);
        const double sx = of_x.sum[x1] - of_x.sum[x0], sy = of_y.sum[y1] - of_y.sum[y0];
        const double xx = of_x.square[x1] - of_x.square[x0] - sx * sx / n;
        const double yy = of_y.square[y1] - of_y.square[y0] - sy * sy / n;
        const auto at = static_cast<std::size_t>(lag < 0 ? lag + std::ssize(products) : lag);
        constexpr double moves = 1e-9;  // of the whole signal's energy
        const bool both_move = xx > moves * of_x.square.back() && yy > moves * of_y.square.back();
        scan.correlation.push_back(both_move ? (products[at] - sx * sy / n) / std::sqrt(xx * yy) : 0.0);
    }
    return scan;
}

std::vector<LagPeak> peaks_of(const LagScan& scan) {
    const std::size_t lags = scan.correlation.size();
    std::vector<std::size_t> downwards(lags);
    std::iota(downwards.begin(), downwards.end(), std::size_t{0});
    std::ranges::stable_sort(
        downwards, [&](std::size_t a, std::size_t b) { return height_at(scan, a) > height_at(scan, b); });
    Hills hills(lags);
    std::vector<LagPeak> peaks;
    for (const std::size_t k : downwards) {
        const bool has_left = k > 0 && hills.is_above(k - 1),
                   has_right = k + 1 < lags && hills.is_above(k + 1);
        if (!has_left && !has_right) hills.begin_at(k);
        if (has_left) hills.add(k, k - 1);
        if (has_right && !has_left) hills.add(k, k + 1);
        if (!has_left || !has_right) continue;
        std::size_t higher = hills.top_of(k - 1), lower = hills.top_of(k + 1);
        if (height_at(scan, lower) > height_at(scan, higher)) std::swap(higher, lower);
        hills.join(lower, higher);
        if (const double fall = height_at(scan, lower) - height_at(scan, k); fall > 0.0)
            peaks.push_back({lower, fall});
    }
    if (lags > 0) peaks.push_back({downwards.front(), height_at(scan, downwards.front())});
    std::ranges::stable_sort(peaks, std::greater{},
                             [&](const LagPeak& peak) { return height_at(scan, peak.at); });
    return peaks;
}

std::size_t width_at_half_height(const LagScan& scan, std::size_t peak) {
    const double half = 0.5 * height_at(scan, peak);
    std::size_t low = peak, high = peak;
    while (low > 0 && height_at(scan, low - 1) > half) --low;
    while (high + 1 < scan.correlation.size() && height_at(scan, high + 1) > half) ++high;
    return high - low + 1;
}

}  // namespace fidservo::imports
