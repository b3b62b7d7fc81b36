// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/camera.h"

#include <algorithm>
#include <array>

namespace fidservo::plant {

namespace {

constexpr std::array geometry_ports{Port::camera_x,      Port::camera_y,      Port::camera_rotation,
                                    Port::camera_tilt_u, Port::camera_tilt_v, Port::camera_scale};

std::array<double, camera_variable::count> formula_variables(double time_s, double s_mm) {
    using namespace camera_variable;
    std::array<double, count> variables{};
    variables[time] = time_s;
    variables[camera_place] = s_mm;
    return variables;
}

}  // namespace

bool geometry_changes(const CameraDeviation& deviation) {
    return std::ranges::any_of(geometry_ports, [&](Port port) { return deviation.formulas.act(port); });
}

CameraDeviation deviation_at(const CameraDeviation& deviation, double time_s, double s_mm) {
    CameraDeviation there = deviation;
    const auto variables = formula_variables(time_s, s_mm);
    const auto added = [&](Port port) {
        return deviation.formulas.act(port) ? deviation.formulas.value(port, variables, {}) : 0.0;
    };
    there.offset_mm += Eigen::Vector2d(added(Port::camera_x), added(Port::camera_y));
    there.rotation_rad += added(Port::camera_rotation);
    there.tilt_rad += Eigen::Vector2d(added(Port::camera_tilt_u), added(Port::camera_tilt_v));
    there.pixel_scale += added(Port::camera_scale);
    return there;
}

double stamp_delay_s(const CameraDeviation& deviation, double time_s) {
    if (!deviation.formulas.act(Port::frame_time)) return deviation.delay_s;
    return deviation.delay_s + deviation.formulas.value(Port::frame_time, formula_variables(time_s, 0.0), {});
}

double exposed_s(const CameraDeviation& deviation, double stamp_s) {
    double at_s = (stamp_s - deviation.delay_s) / deviation.clock_rate;
    if (!deviation.formulas.act(Port::frame_time)) return at_s;
    constexpr int rounds = 4;  // delays change slowly beside time
    for (int round = 0; round < rounds; ++round)
        at_s = (stamp_s - stamp_delay_s(deviation, at_s)) / deviation.clock_rate;
    return at_s;
}

Eigen::Vector2d tag_offset_mm(const CameraDeviation& deviation, const Eigen::Vector2d& tag_mm) {
    using namespace camera_variable;
    std::array<double, count> variables{};
    variables[tag_x] = tag_mm.x();
    variables[tag_y] = tag_mm.y();
    const auto added = [&](Port port) {
        return deviation.formulas.act(port) ? deviation.formulas.value(port, variables, {}) : 0.0;
    };
    return {added(Port::tag_x), added(Port::tag_y)};
}

double row_delay_s(const CameraGeometry& camera, const CameraDeviation& deviation, double v_px) {
    if (deviation.readout_s == 0.0 || camera.height_px < 2) return 0.0;
    return deviation.readout_s * (v_px / (camera.height_px - 1) - 0.5);
}

}  // namespace fidservo::plant
