// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/draw/unlisted_effects.h"

#include "core/rig.h"
#include "src/selfcheck/draw/listed_effects.h"

#include <array>

namespace fidservo::selfcheck {
namespace {

/// The contraction follows another law inside the major loop.
void duhem_hysteresis(TrueRig& rig, double /*size*/, NoiseStream& /*draw*/) {
    rig.departures.hysteresis.law = reference::HysteresisLaw::duhem;
}

/// The driver starts to heat at another voltage.
void heater_onset(TrueRig& rig, double size_V, NoiseStream& draw) {
    rig.rig.micro->heater.onset_V += random_sign(draw) * size_V;
}

/// The heating power is not proportional to the voltage above onset.
void heater_curvature(TrueRig& rig, double size, NoiseStream& draw) {
    rig.departures.heater.curvature = random_sign(draw) * size;
}

/// The motor weakens as it warms.
void drive_fading(TrueRig& rig, double size_per_s, NoiseStream& /*draw*/) {
    rig.departures.drive.fading_per_s = size_per_s;
}

void quadratic_drag(TrueRig& rig, double size_V_s2_per_mm2, NoiseStream& /*draw*/) {
    rig.departures.friction.drag_V_s2_per_mm2 = size_V_s2_per_mm2;
}

/// The encoder's scale is bent: it reads too much, or too little, towards both ends.
void encoder_bow(TrueRig& rig, double size_per_mm, NoiseStream& draw) {
    rig.departures.encoder.bow_per_mm = random_sign(draw) * size_per_mm;
}

/// The Hall sensor's zero follows the temperature of the wire beside it.
void hall_warmth(TrueRig& rig, double size_V_per_degC, NoiseStream& draw) {
    rig.departures.hall.warm_V_per_degC = random_sign(draw) * size_V_per_degC;
}

/// Pixels are not square.
void pixel_aspect(TrueRig& rig, double size, NoiseStream& draw) {
    rig.departures.camera.aspect = 1.0 + random_sign(draw) * size;
}

/// The tags are printed at another distance from each other, at their nominal size.
void tag_pitch(TrueRig& rig, double size, NoiseStream& draw) {
    rig.rig.fiducials->pitch_x_mm *= 1.0 + random_sign(draw) * size;
}

/// The tags are printed at another size, at their nominal places.
void tag_side(TrueRig& rig, double size, NoiseStream& draw) {
    rig.rig.fiducials->side_mm *= 1.0 + random_sign(draw) * size;
}

/// The macro controller runs with another gain.
void macro_controller_gain(TrueRig& rig, double size, NoiseStream& draw) {
    rig.rig.macro.pd->e0_V_per_count *= 1.0 + random_sign(draw) * size;
}

/// The micro controller runs with another gain.
void micro_controller_gain(TrueRig& rig, double size, NoiseStream& draw) {
    rig.rig.micro->pi->kp_V_per_mm *= 1.0 + random_sign(draw) * size;
}

constexpr std::array effects{
    UnlistedEffect{"duhem_hysteresis", "micro.hysteresis", 1.0, 1.0, duhem_hysteresis},
    UnlistedEffect{"heater_onset", "micro.heater", 0.0005, 0.05, heater_onset},
    UnlistedEffect{"heater_curvature", "micro.heater", 5e-4, 0.1, heater_curvature},
    UnlistedEffect{"drive_fading", "macro.drive", 1e-4, 1e-2, drive_fading},
    UnlistedEffect{"quadratic_drag", "macro.friction", 3e-8, 1e-5, quadratic_drag},
    UnlistedEffect{"encoder_bow", "macro.encoder", 3e-6, 1e-4, encoder_bow},
    UnlistedEffect{"hall_warmth", "micro.hall", 1e-5, 1e-3, hall_warmth},
    UnlistedEffect{"pixel_aspect", "camera.geometry", 1e-4, 2e-2, pixel_aspect},
    UnlistedEffect{"tag_pitch", "plate", 3e-4, 5e-3, tag_pitch},
    UnlistedEffect{"tag_side", "plate", 5e-4, 2e-2, tag_side},
    UnlistedEffect{"macro_controller_gain", "controller", 0.01, 0.3, macro_controller_gain},
    UnlistedEffect{"micro_controller_gain", "controller", 0.02, 0.3, micro_controller_gain},
};

}  // namespace

std::span<const UnlistedEffect> unlisted_effects() {
    return effects;
}

}  // namespace fidservo::selfcheck
