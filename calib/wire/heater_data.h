// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recordings of a heated wire, and what is done to them before a model is fitted
// (calib/wire/heater_fit.h).
#include "core/micro_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fidservo::calib {

/// One recording, a row a tick: the command held from the row on, and what a sensor read at the row.
struct HeaterRun {
    double tick_s = 0.0;
    std::vector<double> command;            ///< V, or any unit of a heater's drive
    std::vector<double> reading;            ///< ADC counts of the Hall sensor, or degC of a thermometer
    std::vector<double> weight = {};        ///< of a row's residual; empty: all 1; 0 leaves a row out
    std::vector<double> ambient_degC = {};  ///< measured; empty: the model's
    std::optional<double> start_degC = {};  ///< temperature at the first row; else ambient
};

/// Samples that no drive gave: isolated, at most two rows long, and away from the median of the eleven rows
/// around by more than three tenths of the commands' usual range and three times as much as those rows are
/// spread. Their indices, ascending.
std::vector<std::size_t> corrupt_samples(std::span<const double> command);

/// The commands with some samples replaced by the last good one before them.
std::vector<double> without_samples(std::span<const double> command, std::span<const std::size_t> corrupt);

/// A wire's temperature from where the platform is, by the inverse hysteresis.
struct InferredTemperature {
    std::vector<double> temp_degC;
    /// Hall counts per degC: how much a row knows of the temperature. 0 where the wire stands at an end of
    /// its travel, where the contraction says nothing.
    std::vector<double> sensitivity_lsb_per_degC;
};

/// Follows the Hall readings, averaged over eleven rows, through the inverse Preisach model, which remembers
/// the turns as the wire does. The wire starts cold, at the heater's ambient temperature.
InferredTemperature infer_temperature(const MicroModel& model, std::span<const double> hall_adc);

}  // namespace fidservo::calib
