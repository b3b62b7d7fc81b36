// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/macro/macro_motion.h"

#include "core/demand.h"

#include <cmath>

namespace fidservo::calib {

double drive_speed_mm_per_s(const MacroMotion& motion, double command_V) {
    const auto line = [&](double size_V) {
        return motion.speed_mm_per_s + motion.slope_mm_per_s_per_V * (size_V - motion.centre_V);
    };
    if (command_V >= motion.forward_threshold_V) return line(command_V + motion.offset_V);
    if (-command_V >= motion.backward_threshold_V) return -line(-command_V - motion.offset_V);
    return 0.0;
}

MacroPropagation::MacroPropagation(const MacroMotion& motion, double tick_s)
    : motion_(motion), tick_s_(tick_s) {
    FIDSERVO_DEMAND(tick_s > 0.0 && motion.time_constant_s > 0.0);
    const double lost = -std::expm1(-tick_s / motion.time_constant_s);
    decay_ = 1.0 - lost;
    glide_s_ = motion.time_constant_s * lost;
}

void MacroPropagation::glide(MacroMotionState& state, double terminal_mm_per_s, double duration_s) const {
    const double lost = -std::expm1(-duration_s / motion_.time_constant_s);
    const double excess_mm_per_s = state.velocity_mm_per_s - terminal_mm_per_s;
    state.position_mm += terminal_mm_per_s * duration_s + excess_mm_per_s * motion_.time_constant_s * lost;
    state.velocity_mm_per_s -= excess_mm_per_s * lost;
}

void MacroPropagation::advance(MacroMotionState& state, double command_V) const {
    const double drive_mm_per_s = drive_speed_mm_per_s(motion_, command_V);
    const double friction_mm_per_s = motion_.friction_mm_per_s;
    const bool held = std::abs(drive_mm_per_s) <= friction_mm_per_s;
    const bool stands = state.velocity_mm_per_s == 0.0;
    if (stands && held) return;

    const double side = std::copysign(1.0, stands ? drive_mm_per_s : state.velocity_mm_per_s);
    const double terminal_mm_per_s = drive_mm_per_s - side * friction_mm_per_s;
    const double excess_mm_per_s = state.velocity_mm_per_s - terminal_mm_per_s;
    const double next_mm_per_s = terminal_mm_per_s + excess_mm_per_s * decay_;
    if (side * next_mm_per_s >= 0.0) {
        state.position_mm += terminal_mm_per_s * tick_s_ + excess_mm_per_s * glide_s_;
        state.velocity_mm_per_s = next_mm_per_s;
        return;
    }
    const double turn_s = motion_.time_constant_s * std::log1p(-state.velocity_mm_per_s / terminal_mm_per_s);
    glide(state, terminal_mm_per_s, turn_s);
    state.velocity_mm_per_s = 0.0;
    if (!held) glide(state, drive_mm_per_s + side * friction_mm_per_s, tick_s_ - turn_s);
}

}  // namespace fidservo::calib
