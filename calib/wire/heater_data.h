// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recordings of a heated wire, and their preparation for the fit of a model (calib/wire/heater_fit.h).
#include "core/micro_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::calib {

/// One recording with a row per tick: the command held from the row on, and the sensor's reading at the row.
struct HeaterRun {
    double tick_s = 0.0;
    std::vector<double> command;      ///< V, or any unit of a heater's drive
    std::vector<double> reading;      ///< ADC counts of the Hall sensor, or degC of a thermometer
    std::vector<double> weight = {};  ///< weight of each row's residual; empty: all 1; 0 leaves a row out
    /// Measured ambient temperature of each row; empty: the model's is used.
    std::vector<double> ambient_degC = {};
    std::optional<double> start_degC = {};  ///< temperature at the first row; empty: ambient
};

/// Ascending indices of corrupt command samples: isolated outliers of at most two rows that differ from the
/// median of the surrounding eleven rows by more than 0.3 times the commands' usual range and by more than
/// three times the spread of these rows.
std::vector<std::size_t> corrupt_samples(std::span<const double> command);

/// The commands with some samples replaced by the last good one before them.
std::vector<double> without_samples(std::span<const double> command, std::span<const std::size_t> corrupt);

/// The wire's temperature from the platform's position, by the inverse hysteresis.
struct InferredTemperature {
    std::vector<double> temp_degC;
    /// Hall counts per degC: how well a row determines the temperature. 0 where the wire is at an end of its
    /// travel, where the contraction contains no information.
    std::vector<double> sensitivity_lsb_per_degC;
};

/// Applies the inverse Preisach model, with its memory, to the Hall readings averaged over eleven rows. The
/// wire starts cold, at the heater's ambient temperature.
InferredTemperature infer_temperature(const MicroModel& model, std::span<const double> hall_adc);

}  // namespace fidservo::calib
