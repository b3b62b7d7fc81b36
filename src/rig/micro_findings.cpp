// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/hall.h"
#include "core/rig.h"
#include "src/rig/finding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// The thickest actuator wire that is sold, 0.5 mm, relaxes in 17 s by its data sheet; a thin one of 25 um in
/// a fifth of a second. Beyond a few times that, it is no wire in air.
constexpr double longest_wire_tau_s = 60.0;
/// Nickel-titanium loses its memory where it is annealed, from about 400 degC.
constexpr double annealing_degC = 400.0;
/// Positioning keeps 1 mm from either end of the platform's travel where it parks
/// (src/session/motion_params.cpp).
constexpr double least_platform_travel_mm = 2.0;
constexpr double least_stroke_share = 0.9;

void look_at_heater(const Rig& rig, std::vector<Finding>& findings) {
    const HeaterParameters& heater = rig.micro->heater;
    for (const auto& [key, tau_s] : {std::pair{"micro.heater.heating_tau_s", heater.heating_tau_s},
                                     std::pair{"micro.heater.cooling_tau_s", heater.cooling_tau_s}})
        if (tau_s > longest_wire_tau_s || tau_s < rig.tick_s)
            findings.push_back({key, fmt::format("{:g}", tau_s),
                                "no wire in air is so slow, or as fast as a tick",
                                fmt::format("0.1 to 20 s; between a tick and {:g} s", longest_wire_tau_s)});
    const double hottest_degC =
        heater.ambient_degC + heater.gain_degC_per_V * (heater.limit_V - heater.onset_V);
    const FodTable& fod = *rig.micro->fod;
    const std::string gain = fmt::format("{:g}", heater.gain_degC_per_V);
    const double drive_V = heater.limit_V - heater.onset_V;
    if (hottest_degC > annealing_degC)
        findings.push_back(
            {"micro.heater.gain_degC_per_V", gain,
             fmt::format("held at limit_V, the wire would be at {:.4g} degC, where it anneals", hottest_degC),
             fmt::format("below {:g} degC: at most {:.3g}", annealing_degC,
                         (annealing_degC - heater.ambient_degC) / drive_V)});
    const double travel_mm = rig.micro->high_mm - rig.micro->low_mm;
    const double hot_mm = fod.contraction_mm(hottest_degC, hottest_degC);
    if (fod.stroke_mm() < least_stroke_share * travel_mm || fod.stroke_mm() > travel_mm / least_stroke_share)
        findings.push_back({"micro.preisach_fod", "its table",
                            fmt::format("the wire's stroke there is {:.4g} mm", fod.stroke_mm()),
                            fmt::format("about micro.travel_mm, {:g} mm", travel_mm)});
    else if (hot_mm < least_stroke_share * travel_mm)
        findings.push_back(
            {"micro.heater.gain_degC_per_V", gain,
             fmt::format(
                 "held at limit_V, the wire would be at {:.4g} degC and contract by {:.3g} mm of {:g} mm",
                 hottest_degC, hot_mm, travel_mm),
             fmt::format("enough for the table's {:g} degC: about {:.3g}", fod.high_degC(),
                         (fod.high_degC() - heater.ambient_degC) / drive_V)});
}

void look_at_hall(const MicroParameters& micro, std::vector<Finding>& findings) {
    const HallParameters& hall = micro.hall;
    const double rising_mm = hall.cubic > 0.0
                                 ? hall.half_range_mm * std::sqrt((1.0 + hall.cubic) / (3.0 * hall.cubic))
                                 : std::numeric_limits<double>::infinity();
    const double low_mm = hall.centre_mm - rising_mm, high_mm = hall.centre_mm + rising_mm;
    if (micro.low_mm < low_mm || micro.high_mm > high_mm)
        findings.push_back(
            {"micro.hall.half_range_mm", fmt::format("{:g}", hall.half_range_mm),
             fmt::format("the curve rises from {:.4g} to {:.4g} mm only: beyond, a reading has two places",
                         low_mm, high_mm),
             fmt::format("rising over micro.travel_mm, {:g} to {:g} mm", micro.low_mm, micro.high_mm)});
    const auto [least_V, most_V] = std::minmax({hall_voltage_V(hall, std::max(micro.low_mm, low_mm)),
                                                hall_voltage_V(hall, std::min(micro.high_mm, high_mm))});
    if (least_V < 0.0 || most_V > hall.adc_range_V)
        findings.push_back(
            {"micro.hall.span_V", fmt::format("{:g}", hall.span_V),
             fmt::format("over the travel the sensor gives {:.4g} to {:.4g} V: the converter clips it",
                         least_V, most_V),
             fmt::format("within 0 to adc_range_V, {:g} V", hall.adc_range_V)});
    const double travel_mm = micro.high_mm - micro.low_mm;
    const double lsb_mm = hall_lsb_V(hall) * std::max(1.0, hall.noise_lsb) /
                          hall_slope_V_per_mm(hall, std::clamp(hall.centre_mm, micro.low_mm, micro.high_mm));
    if (std::abs(lsb_mm) > coarsest_step_share * travel_mm)
        findings.push_back(
            {"micro.hall.adc_bits", fmt::format("{}", hall.adc_bits),
             fmt::format("a reading tells the platform's place to {:.3g} mm only", std::abs(lsb_mm)),
             fmt::format("at most 1 % of the travel, {:g} mm", coarsest_step_share * travel_mm)});
}

void look_at_limits(const MicroParameters& micro, std::vector<Finding>& findings) {
    if (!micro.pi) return;
    if (micro.pi->high_V > micro.heater.limit_V)
        findings.push_back({"micro.pi.high_V", fmt::format("{:g}", micro.pi->high_V),
                            "the controller would ask for more than the wire's driver gives",
                            fmt::format("micro.heater.limit_V, {:g} V", micro.heater.limit_V)});
    if (micro.pi->low_V > 0.5 * (micro.heater.onset_V + micro.heater.limit_V))
        findings.push_back({"micro.pi.low_V", fmt::format("{:g}", micro.pi->low_V),
                            "the controller could not let the wire cool",
                            fmt::format("micro.heater.onset_V, {:g} V", micro.heater.onset_V)});
}

}  // namespace

std::vector<Finding> micro_findings(const Rig& rig) {
    std::vector<Finding> findings;
    if (!rig.micro) return findings;
    const double travel_mm = rig.micro->high_mm - rig.micro->low_mm;
    if (travel_mm <= least_platform_travel_mm || travel_mm < 2.0 * rig.macro.encoder_resolution_mm)
        findings.push_back(
            {"micro.travel_mm", fmt::format("[{:g}, {:g}]", rig.micro->low_mm, rig.micro->high_mm),
             "positioning keeps 1 mm from either end, and bridges what a count of the carriage leaves",
             fmt::format("longer than {:g} mm",
                         std::max(least_platform_travel_mm, 2.0 * rig.macro.encoder_resolution_mm))});
    look_at_heater(rig, findings);
    look_at_hall(*rig.micro, findings);
    look_at_limits(*rig.micro, findings);
    return findings;
}

}  // namespace fidservo
