// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/hall_range.h"

#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fidservo::gap {
namespace {

/// Noise before rounding, in LSB, of readings between their extremes, by second differences d of neighbouring
/// readings: mean d^2 = 6 (noise^2 + 1/12), as long as the platform's acceleration contributes little to d.
double noise_inside_lsb(const std::vector<Recording>& recordings, const HallRange& extremes) {
    constexpr double most_lsb = 8.0, fewest = 1000.0, squares_of_second_difference = 6.0;
    double squares = 0.0, count = 0.0;
    for (const Recording& recording : recordings)
        for (std::size_t k = 1; k + 1 < recording.rows.size(); ++k) {
            const auto reading = [&](std::size_t row) {
                return within(extremes, recording.rows[row].hall_adc);
            };
            const double difference = reading(k - 1) - 2.0 * reading(k) + reading(k + 1);
            if (!(std::abs(difference) <= most_lsb)) continue;
            squares += difference * difference;
            count += 1.0;
        }
    return count < fewest ? 0.0
                          : std::sqrt(std::max(
                                0.0, squares / count / squares_of_second_difference - 1.0 / uniform_divisor));
}

/// The largest number of equal readings in a row that noise can explain.
double longest_chance(double noise_lsb) {
    constexpr double log_of_chance = -20.7;  // of a probability of 1e-9
    if (noise_lsb <= 0.0) return std::numeric_limits<double>::infinity();
    const double repeats = std::erf(0.5 / (std::numbers::sqrt2 * noise_lsb));
    return repeats < 1.0 ? log_of_chance / std::log(repeats) : std::numeric_limits<double>::infinity();
}

double longest_stay(const std::vector<Recording>& recordings, double hall_adc) {
    std::size_t longest = 0;
    for (const Recording& recording : recordings) {
        std::size_t stay = 0;
        for (const StageRow& row : recording.rows) {
            stay = row.hall_adc == hall_adc ? stay + 1 : 0;
            longest = std::max(longest, stay);
        }
    }
    return static_cast<double>(longest);
}

}  // namespace

double mm_per_lsb(const HallParameters& hall) {
    return hall_lsb_V(hall) / hall_slope_V_per_mm(hall, hall.centre_mm);
}

double within(const HallRange& range, double hall_adc) {
    return hall_adc > range.low_adc && hall_adc < range.high_adc ? hall_adc
                                                                 : std::numeric_limits<double>::quiet_NaN();
}

HallRange hall_range(const std::vector<Recording>& recordings, const HallParameters& hall) {
    HallRange range{0.0, std::exp2(hall.adc_bits) - 1.0};
    HallRange extremes{range.high_adc, range.low_adc};
    for (const Recording& recording : recordings)
        for (const StageRow& row : recording.rows) {
            if (std::isnan(row.hall_adc)) continue;
            extremes.low_adc = std::min(extremes.low_adc, row.hall_adc);
            extremes.high_adc = std::max(extremes.high_adc, row.hall_adc);
        }
    const double bound = longest_chance(noise_inside_lsb(recordings, extremes));
    if (longest_stay(recordings, extremes.low_adc) > bound)
        range.low_adc = std::max(range.low_adc, extremes.low_adc);
    if (longest_stay(recordings, extremes.high_adc) > bound)
        range.high_adc = std::min(range.high_adc, extremes.high_adc);
    return range;
}

}  // namespace fidservo::gap
