// SPDX-License-Identifier: GPL-3.0-or-later
// The Hall sensor's calibration: displacement by the camera against the converter's reading.
#include "core/hall.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "src/identify/identify.h"
#include "src/report/xy_chart.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

/// The platform over its travel and back, slowly, under a camera that sees a fiducial.
Recording slow_travel(const Laboratory& laboratory) {
    constexpr double period_s = 30.0, low_V = 1.30, high_V = 1.70, rest_s = 1.0;
    return perform(laboratory, "hall-travel",
                   {.kind = "hall-travel",
                    .duration_s = 2.0 * period_s,
                    .carriage_mm = 100.0,
                    .micro_V = [](double t_s) {
                        const double phase = std::fmod(std::max(0.0, t_s - rest_s), period_s) / period_s;
                        return low_V + (high_V - low_V) * (1.0 - std::abs(2.0 * phase - 1.0));
                    }});
}

double value_of(const Identified& identified, const std::string& key) {
    const auto found = std::ranges::find(identified.values, key, &IdentifiedValue::key);
    if (found == identified.values.end())
        throw RunFault(fmt::format("calibration of the Hall sensor: {}: not determined", key));
    return found->value;
}

}  // namespace

Chapter hall_sensor(const Laboratory& laboratory) {
    const MicroParameters& micro = laboratory.rig.micro.value();
    const Identified found = calibrate_hall({laboratory.rig, {slow_travel(laboratory)}, std::nullopt, 0.0});
    HallParameters curve = micro.hall;
    curve.mid_V = value_of(found, "micro.hall.mid_V");
    curve.span_V = value_of(found, "micro.hall.span_V");
    curve.centre_mm = value_of(found, "micro.hall.centre_mm");
    curve.cubic = value_of(found, "micro.hall.cubic");

    constexpr int points = 81;
    report::XyCurve calibrated{"calibrated", {}, {}}, straight{"straight line", {}, {}};
    double worst_um = 0.0;
    for (int i = 0; i < points; ++i) {
        const double x_mm = micro.low_mm + (micro.high_mm - micro.low_mm) * i / (points - 1);
        calibrated.x.push_back(x_mm);
        calibrated.y.push_back(hall_voltage_V(curve, x_mm) / hall_lsb_V(curve));
        worst_um = std::max(worst_um,
                            1e3 * std::abs(hall_position_mm(curve, hall_voltage_V(micro.hall, x_mm)) - x_mm));
    }
    straight.x = {calibrated.x.front(), calibrated.x.back()};
    straight.y = {calibrated.y.front(), calibrated.y.back()};
    const double um_per_bit =
        1e3 * (micro.high_mm - micro.low_mm) / (calibrated.y.back() - calibrated.y.front());

    Chapter chapter{"hall", "The Hall sensor", "", {}};
    chapter.html = chart_figure(
        "The sensor's S-shaped curve, calibrated against the camera while the platform travels slowly under "
        "a fiducial.",
        report::xy_chart_svg("displacement, mm", "reading, LSB", {straight, calibrated}));
    chapter.claims = {
        {"Hall sensor", "Resolution 1.953 um per bit on average.",
         fmt::format("{:.3f} um per bit", um_per_bit), holds_if(std::abs(um_per_bit - 1.953) < 0.01), ""},
        {"Hall sensor", "The calibration curve can be inverted over the travel to the system's 5 um.",
         fmt::format("at most {:.1f} um from the rig's true curve", worst_um), holds_if(worst_um <= 5.0),
         ""}};
    return chapter;
}

}  // namespace fidservo::reproduce
