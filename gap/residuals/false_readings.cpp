// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/false_readings.h"

#include "core/rig.h"
#include "gap/evidence/hall_range.h"
#include "gap/fit/score.h"
#include "gap/links/tag_link.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace fidservo::gap {
namespace {

constexpr double not_judged = std::numeric_limits<double>::quiet_NaN();

/// The floor of a sensor's errors, mm.
double floor_mm(const Evidence& evidence, Signal sensor) {
    const Rig& rig = evidence.rig();
    return evidence.floor(sensor) *
           (sensor == Signal::encoder ? rig.macro.encoder_resolution_mm : mm_per_lsb(rig.micro->hall));
}

/// Prediction minus reading of a sensor in each row of a recording, mm; NaN where it is not judged.
std::vector<double> sensor_errors_mm(const Evidence& evidence, const Errors& errors, std::size_t run,
                                     Signal sensor) {
    const double per_floor_mm = floor_mm(evidence, sensor);
    std::vector<double> found(evidence.recordings()[run].rows.size(), not_judged);
    for (const Window& window : evidence.windows()) {
        if (window.run != run || window.signal != sensor) continue;
        for (std::size_t k = window.begin; k < window.end; ++k)
            found[window.first_row + (k - window.begin)] = per_floor_mm * errors[k];
    }
    return found;
}

/// What a window's detections say of a sensor.
struct Sights {
    std::span<const TagSighting> sightings;
    std::vector<float> along;      ///< displacement along the motion, in floors
    std::vector<double> error_mm;  ///< prediction minus reading of the sensor
    double noise_mm;               ///< of the reading, which tags are predicted from after it was smoothed
};

/// Mean square, in floors squared, of the displacements about their mean, after those by false readings were
/// taken from them; NaN where fewer than three detections are judged.
/// @param false_share  of its errors, by which the reading is off: 0 or 1
double mean_square_about_mean(const Sights& sights, double false_share) {
    constexpr std::size_t least = 3;
    struct Displacement {
        double floors, weight;
    };
    std::vector<Displacement> all;
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < sights.sightings.size(); ++i) {
        const TagSighting& sighting = sights.sightings[i];
        const double tag_floor_mm = sighting.floors_px[0] / sighting.slope_px_per_mm;
        const double left_mm = tag_floor_mm * sights.along[i] + false_share * sights.error_mm[i];
        if (!std::isfinite(left_mm)) continue;
        const double weight = 1.0 / (std::pow(tag_floor_mm, 2) + std::pow(sights.noise_mm, 2));
        all.push_back({left_mm, weight});
        sum += weight * left_mm;
        weights += weight;
    }
    if (all.size() < least) return not_judged;
    double squares = 0.0;
    for (const auto& [left_mm, weight] : all) squares += weight * std::pow(left_mm - sum / weights, 2);
    return squares / static_cast<double>(all.size() - 1);
}

/// What remains of the tags' displacement in each window where no reading is false, and where a sensor's is.
struct Remaining {
    std::vector<double> of_none, of_sensor;  ///< mean squares; NaN in windows that are not judged
};

Remaining remaining(const Evidence& evidence, const Errors& errors, Signal sensor) {
    const std::vector<Window>& windows = evidence.windows();
    Remaining found{std::vector(windows.size(), not_judged), std::vector(windows.size(), not_judged)};
    std::size_t run = windows.size();
    std::vector<double> sensor_mm;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const Window& window = windows[w];
        if (window.signal != Signal::tag) continue;
        if (window.run != run) sensor_mm = sensor_errors_mm(evidence, errors, run = window.run, sensor);
        const std::vector<StageRow>& rows = evidence.recordings()[run].rows;
        const std::size_t detections = (window.end - window.begin) / corner_values;
        if (detections == 0) continue;
        Sights sights{.sightings = std::span(&evidence.sighting(run, window.first_detection), detections),
                      .along = {},
                      .error_mm = {},
                      .noise_mm = floor_mm(evidence, sensor)};
        std::size_t row = window.first_row;
        for (std::size_t i = 0; i < detections; ++i) {
            const auto since_start_s = [&](std::size_t at) {
                return seconds(rows[at].time_ns - rows.front().time_ns);
            };
            while (row + 1 < rows.size() && since_start_s(row + 1) <= sights.sightings[i].stamp_s) ++row;
            sights.along.push_back(errors[window.begin + corner_values * i]);
            sights.error_mm.push_back(sensor_mm[row]);
        }
        found.of_none[w] = mean_square_about_mean(sights, 0.0);
        found.of_sensor[w] = mean_square_about_mean(sights, 1.0);
    }
    return found;
}

}  // namespace

std::optional<Signal> sensor_that_displaces_tags(const Evidence& evidence, const Errors& errors) {
    constexpr std::array sensors{Signal::encoder, Signal::hall};
    constexpr double odds = 20.0;  // to one that the reading is false
    const double log_of_odds = std::log(odds);
    std::optional<Signal> found;
    double most = log_of_odds;
    for (const Signal sensor : sensors) {
        if (std::isnan(evidence.floor(sensor))) continue;
        const Remaining left = remaining(evidence, errors, sensor);
        const double gain = compare(evidence.windows(), left.of_none, left.of_sensor).gain;
        if (gain < most) continue;
        most = gain;
        found = sensor;
    }
    return found;
}

}  // namespace fidservo::gap
