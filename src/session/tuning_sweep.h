// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The tuning sweep: the platform once over its travel, up and down, under known commands. What the camera and
// the Hall sensor see of it calibrates the sensor, the camera's time stamps and the model of the actuator.
#include "calib/hall/hall_map.h"
#include "core/micro_model.h"
#include "core/result.h"

#include <optional>
#include <vector>

namespace fidservo {

/// What a sweep recorded.
struct SweepRecord {
    calib::HallTrace hall;
    std::vector<double> command_V;
    std::vector<calib::CameraSight> sights;
};

/// Open-loop commands of the sweep: rest, heat until contracted, cool until extended.
class SweepProfile {
  public:
    explicit SweepProfile(const MicroModel& model) : model_(model) {}
    static constexpr int rest_ticks = 100;
    static constexpr int longest_ticks = 9000;
    /// Largest number of ticks in a sweep, including those left out by a late loop.
    static constexpr std::size_t most_ticks = 2 * longest_ticks;

    /// The command from this tick on, V; empty when the sweep is over.
    std::optional<double> next(double hall_adc);

  private:
    MicroModel model_;
    int ticks_ = 0;
    bool cooling_ = false;
};

/// The model fitted to the sweep, and the delay of the camera's time stamps.
struct Tuning {
    MicroModel model;
    double camera_delay_s;
    double hall_residual_mm;
    double actuator_residual_mm;
};

/// Fits the model to a sweep. Fails with Reason::not_identifiable if the sweep does not determine it.
Result<Tuning> tune(const MicroModel& nominal, const SweepRecord& sweep, double tick_s, double exposure_s);

/// The state of the model's wire at the end of a sweep that began cold.
PreisachMemory wire_after(const MicroModel& model, const std::vector<double>& command_V, double tick_s);

}  // namespace fidservo
