// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/noise_floor.h"

#include "core/median.h"
#include "gap/evidence.h"
#include "gap/evidence/clear_detections.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace fidservo::gap {

namespace {

constexpr std::size_t quiet_rows = 200;

double below(double level, double mean, double noise) {
    if (noise <= 0.0) return level > mean ? 1.0 : 0.0;
    return 0.5 * std::erfc((mean - level) / (noise * std::numbers::sqrt2));
}

/// The mean and the scatter about a straight line; empty where a value is missing or the line is too steep.
std::optional<QuietStretch> judge(const std::vector<double>& reading, std::size_t first) {
    constexpr double most_rise = 1.0;
    constexpr double rows = quiet_rows;
    double sum = 0.0, moment = 0.0;
    for (std::size_t i = 0; i < quiet_rows; ++i) {
        sum += reading[first + i];
        moment += reading[first + i] * (static_cast<double>(i) - 0.5 * (rows - 1.0));
    }
    // Mathematics: the mean, and the slope of the line of least squares.
    const double mean = sum / rows, slope = moment / (rows * (rows * rows - 1.0) / 12.0);
    if (!(std::abs(slope) * rows < most_rise)) return std::nullopt;
    QuietStretch stretch{mean, 0.0, quiet_rows};
    for (std::size_t i = 0; i < quiet_rows; ++i) {
        const double line = mean + slope * (static_cast<double>(i) - 0.5 * (rows - 1.0));
        stretch.square_sum += (reading[first + i] - line) * (reading[first + i] - line);
    }
    return stretch;
}

}  // namespace

double rounded_variance(double mean, double noise) {
    constexpr double deviations = 6.0;
    const auto reach = static_cast<int>(std::ceil(deviations * noise)) + 1;
    const double nearest = std::floor(mean + 0.5);
    double first = 0.0, second = 0.0;
    for (int i = -reach; i <= reach; ++i) {
        const double probability =
            below(nearest + i + 0.5, mean, noise) - below(nearest + i - 0.5, mean, noise);
        first += probability * i;
        second += probability * i * i;
    }
    return second - first * first;
}

std::vector<QuietStretch> quiet_stretches(const std::vector<double>& reading,
                                          const std::vector<double>& held) {
    std::vector<QuietStretch> found;
    std::size_t since = 0;
    for (std::size_t k = 0; k < reading.size(); ++k) {
        const bool changed = k > 0 && held[k] != held[k - 1];
        if (changed || !std::isfinite(held[k]) || !std::isfinite(reading[k])) since = k + (changed ? 0 : 1);
        if (k + 1 < since + quiet_rows) continue;
        if (const auto stretch = judge(reading, since)) found.push_back(*stretch);
        since = k + 1;
    }
    return found;
}

std::optional<double> noise_before_rounding(std::vector<QuietStretch> stretches) {
    if (stretches.empty()) return std::nullopt;
    constexpr double outlier = 3.0;
    std::vector<double> squares;
    squares.reserve(stretches.size());
    for (const QuietStretch& stretch : stretches) squares.push_back(stretch.square_sum);
    const double limit = outlier * median_of(squares);
    std::erase_if(stretches, [&](const QuietStretch& stretch) { return stretch.square_sum > limit; });
    const auto excess = [&](double noise) {
        double sum = 0.0;
        for (const QuietStretch& stretch : stretches)
            sum += stretch.square_sum -
                   static_cast<double>(stretch.rows - 2) * rounded_variance(stretch.mean, noise);
        return sum;
    };
    constexpr double first_guess = 0.25;
    double low = 0.0, high = first_guess;
    while (excess(high) > 0.0) high *= 2.0;
    constexpr double resolution = 1e-4;
    while (high - low > resolution) {
        const double middle = 0.5 * (low + high);
        (excess(middle) > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double floor_of(double noise) {
    return std::sqrt(noise * noise + 1.0 / uniform_divisor);
}

std::optional<double> corner_noise_px(const std::vector<Recording>& recordings, double frame_s) {
    constexpr std::size_t least_pairs = 20;
    constexpr double mad_of_normal = 0.6744897501960817;
    std::vector<double> sizes;
    for (const Recording& recording : recordings) {
        std::map<int, const TagDetection*> seen;  // latest detection of each tag
        const bool refines = refines_corners(recording);
        for (const TagDetection& now : recording.detections) {
            if (refines && !now.is_refined.value_or(true)) continue;
            const TagDetection* before = std::exchange(seen[now.tag_id], &now);
            if (before == nullptr || now.time_ns <= before->time_ns ||
                seconds(now.time_ns - before->time_ns) > most_steps_apart * frame_s)
                continue;
            for (std::size_t c = 0; c < corner_count; ++c)
                sizes.push_back(std::abs(now.corners_px[c].y() - before->corners_px[c].y()));
        }
    }
    if (sizes.size() < corner_count * least_pairs) return std::nullopt;
    return median_of(sizes) / (mad_of_normal * std::numbers::sqrt2);
}

}  // namespace fidservo::gap
