// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/motion_params.h"

#include "core/input_error.h"
#include "core/rig.h"

#include <algorithm>

namespace fidservo {

namespace {

constexpr double reach_margin_mm = 0.2;  ///< near its ends the wire hardly answers to temperature
constexpr double park_margin_mm = 1.0;
constexpr double frames_to_look_at = 20.0;  ///< at most, for two that agree

}  // namespace

control::PositionerParams positioner_params(const Rig& rig, double tolerance_mm) {
    const auto need = [&rig](bool there, const char* key) {
        if (!there) throw InputError("rig " + rig.name + ": " + key + ": missing; positioning needs it");
    };
    need(rig.micro.has_value(), "micro");
    need(rig.camera.has_value(), "camera");
    need(rig.macro.pd.has_value(), "macro.pd");
    need(rig.micro->pi.has_value(), "micro.pi");
    control::PositionerParams params{};
    params.macro = {*rig.macro.pd, rig.macro.command_limit_V, rig.tick_s};
    params.micro = {nominal_micro_model(*rig.micro), *rig.micro->pi, rig.tick_s, {}};
    params.count_mm = rig.macro.encoder_resolution_mm;
    params.reach_low_mm = rig.micro->low_mm + reach_margin_mm;
    params.reach_high_mm = rig.micro->high_mm - reach_margin_mm;
    params.park_low_mm = rig.micro->low_mm + park_margin_mm;
    params.park_high_mm = rig.micro->high_mm - park_margin_mm;
    params.tolerance_mm = tolerance_mm;
    params.look_timeout_s = std::max(params.look_timeout_s,
                                     rig.camera->latency_s + frames_to_look_at / rig.camera->frame_rate_hz);
    return params;
}

CameraTravel camera_travel(const Rig& rig) {
    if (!rig.micro) return {rig.macro.low_mm, rig.macro.high_mm};
    return {rig.macro.low_mm + rig.micro->low_mm + reach_margin_mm,
            rig.macro.high_mm + rig.micro->high_mm - reach_margin_mm};
}

control::HomingParams homing_params(const Rig& rig) {
    constexpr double speed_mm_per_s = 30.0, stuck_mm = 3.0;
    control::HomingParams params{};
    params.macro = {*rig.macro.pd, rig.macro.command_limit_V, rig.tick_s};
    params.speed_count_per_s = speed_mm_per_s / rig.macro.encoder_resolution_mm;
    params.stuck_error_count = stuck_mm / rig.macro.encoder_resolution_mm;
    params.longest_travel_count =
        1.1 * (rig.macro.high_mm - rig.macro.low_mm) / rig.macro.encoder_resolution_mm;
    return params;
}

}  // namespace fidservo
