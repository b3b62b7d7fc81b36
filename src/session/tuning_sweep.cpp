// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/tuning_sweep.h"

#include "calib/wire/actuator_tuning.h"
#include "core/micro_parameters.h"

#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

constexpr double heat_rise_degC =
    78.0;  ///< carries the wire over its whole transformation within two seconds
constexpr double contracted = 0.94, extended = 0.06;  ///< of the stroke: where the sweep turns and ends
constexpr int longest_heat_ticks = 3000;

}  // namespace

std::optional<double> SweepProfile::next(double hall_adc) {
    const HeaterParameters& heater = model_.heater;
    const double stroke_mm = model_.fod->stroke_mm();
    const double position_mm = platform_position_mm(model_, hall_adc);
    if (++ticks_ <= rest_ticks) return 0.0;
    if (ticks_ > longest_ticks) return std::nullopt;
    if (!cooling_) cooling_ = position_mm >= contracted * stroke_mm || ticks_ > longest_heat_ticks;
    if (!cooling_) return heater.onset_V + heat_rise_degC / heater.gain_degC_per_V;
    if (position_mm <= extended * stroke_mm) return std::nullopt;
    return heater.onset_V;
}

Result<Tuning> tune(const MicroModel& nominal, const SweepRecord& sweep, double tick_s, double exposure_s) {
    const auto map =
        calib::fit_hall_map(nominal.hall, sweep.hall, sweep.sights, exposure_s, SweepProfile::rest_ticks);
    if (!map) return tl::make_unexpected(map.error());
    Tuning tuning{nominal, map->camera_delay_s, map->residual_mm, 0.0};
    tuning.model.hall_correction = map->correction;
    std::vector<double> position_mm;
    position_mm.reserve(sweep.hall.adc.size());
    for (const double adc : sweep.hall.adc) position_mm.push_back(platform_position_mm(tuning.model, adc));
    const auto actuator = calib::tune_actuator(tuning.model, tick_s, position_mm, sweep.command_V);
    if (!actuator) return tl::make_unexpected(actuator.error());
    tuning.model.heater = actuator->heater;
    tuning.model.stroke_scale = actuator->stroke_scale;
    tuning.actuator_residual_mm = actuator->residual_mm;
    spdlog::info(
        "tuned: Hall scale {:.4f}, camera delay {:.1f} ms, room {:.1f} degC, stroke factor {:.4f}; residuals "
        "Hall {:.2f} um, "
        "actuator {:.2f} um",
        map->correction[1], 1e3 * map->camera_delay_s, actuator->heater.ambient_degC, actuator->stroke_scale,
        1e3 * map->residual_mm, 1e3 * actuator->residual_mm);
    return tuning;
}

PreisachMemory wire_after(const MicroModel& model, const std::vector<double>& command_V, double tick_s) {
    PreisachMemory wire = preisach_start(*model.fod, model.heater.ambient_degC);
    for (const double c : command_V)
        preisach_step(*model.fod, wire, heater_step_degC(model.heater, wire.temp_degC, c, tick_s));
    return wire;
}

}  // namespace fidservo
