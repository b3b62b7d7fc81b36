// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/heater_data.h"

#include "core/median.h"

#include <algorithm>
#include <cmath>

namespace fidservo::calib {

namespace {

constexpr std::size_t median_window = 11, half_median_window = median_window / 2;

/// The values around k, fewer at the ends.
std::span<const double> around(std::span<const double> values, std::size_t k) {
    const std::size_t first = k - std::min(k, half_median_window),
                      last = std::min(values.size(), k + half_median_window + 1);
    return values.subspan(first, last - first);
}

double mean(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// From the least to the value that one in twenty of the non-zero samples exceeds.
double usual_range(std::span<const double> command) {
    std::vector<double> sorted;
    sorted.reserve(command.size());
    for (const double value : command)
        if (value != 0.0) sorted.push_back(value);
    if (sorted.empty()) return 0.0;
    std::sort(sorted.begin(), sorted.end());
    const double high = sorted[sorted.size() * 95 / 100];
    return high - std::min(0.0, sorted.front());
}

}  // namespace

std::vector<std::size_t> corrupt_samples(std::span<const double> command) {
    constexpr double share_of_range = 0.3, spreads = 3.0;
    constexpr std::size_t longest = 2;
    const double range = usual_range(command);
    std::vector<std::size_t> corrupt;
    corrupt.reserve(16);
    if (command.size() < median_window) return corrupt;
    for (std::size_t k = 0; k < command.size(); ++k) {
        const auto near = around(command, k);
        const double middle = median_of(std::vector(near.begin(), near.end()));
        std::vector<double> away;
        away.reserve(median_window);
        for (const double value : near) away.push_back(std::abs(value - middle));
        const double threshold = std::max(share_of_range * range, spreads * median_of(away));
        if (std::abs(command[k] - middle) > threshold) corrupt.push_back(k);
    }
    // A run of more than two is a pulse that somebody commanded.
    std::vector<std::size_t> isolated;
    isolated.reserve(corrupt.size());
    for (std::size_t i = 0; i < corrupt.size();) {
        std::size_t end = i + 1;
        while (end < corrupt.size() && corrupt[end] == corrupt[end - 1] + 1) ++end;
        if (end - i <= longest)
            isolated.insert(isolated.end(), corrupt.begin() + static_cast<std::ptrdiff_t>(i),
                            corrupt.begin() + static_cast<std::ptrdiff_t>(end));
        i = end;
    }
    return isolated;
}

std::vector<double> without_samples(std::span<const double> command, std::span<const std::size_t> corrupt) {
    std::vector<double> clean(command.begin(), command.end());
    for (const std::size_t k : corrupt) clean[k] = k > 0 ? clean[k - 1] : 0.0;
    return clean;
}

InferredTemperature infer_temperature(const MicroModel& model, std::span<const double> hall_adc) {
    constexpr double deadband_lsb = 0.6;  ///< of the mean of eleven readings: four standard deviations
    constexpr double probe_degC = 0.25;
    constexpr double least_sensitivity = 1.0;
    const FodTable& table = *model.fod;
    PreisachMemory wire = preisach_start(table, model.heater.ambient_degC);
    InferredTemperature inferred;
    inferred.temp_degC.reserve(hall_adc.size());
    inferred.sensitivity_lsb_per_degC.reserve(hall_adc.size());
    double tracked_adc = std::nan(""), sensitivity = 0.0;
    for (std::size_t k = 0; k < hall_adc.size(); ++k) {
        const double adc = mean(around(hall_adc, k));
        if (!(std::abs(adc - tracked_adc) <= deadband_lsb)) {
            tracked_adc = adc;
            const double x_mm = platform_position_mm(model, adc) / model.stroke_scale;
            const auto temp = preisach_inverse(table, wire, x_mm);
            const double end = x_mm > wire.contraction_mm ? table.high_degC() : table.low_degC();
            preisach_step(table, wire, temp.value_or(end));
            const double rise_mm =
                preisach_peek(table, wire, wire.temp_degC + probe_degC) - wire.contraction_mm;
            const double fall_mm =
                wire.contraction_mm - preisach_peek(table, wire, wire.temp_degC - probe_degC);
            const double lsb_per_mm = hall_slope_V_per_mm(model.hall, x_mm) / hall_lsb_V(model.hall);
            // The way it came: towards where it goes, the branch may be another.
            const bool heats = wire.last_peak_degC == wire.temp_degC;
            const double slope = (heats ? rise_mm : fall_mm) / probe_degC;
            sensitivity = temp ? std::max(0.0, slope * model.stroke_scale * lsb_per_mm) : 0.0;
            if (sensitivity < least_sensitivity) sensitivity = 0.0;
        }
        inferred.temp_degC.push_back(wire.temp_degC);
        inferred.sensitivity_lsb_per_degC.push_back(sensitivity);
    }
    return inferred;
}

}  // namespace fidservo::calib
