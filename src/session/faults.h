// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Deliberate faults of devices, as a drill for the program and its operators.
#include "core/time.h"

#include <array>
#include <string>
#include <string_view>

namespace fidservo {

/// The kind of fault.
enum class FaultKind {
    frames_dropped,     ///< two frames of three are lost
    frames_late,        ///< every frame arrives 100 ms later than it should
    camera_silent,      ///< no frame comes
    image_frozen,       ///< the same picture in every frame
    image_dark,         ///< the light is off: a fiftieth of the grey level
    image_bright,       ///< over-exposed twentyfold
    tag_hidden,         ///< a bar of dirt across the middle of the image, the fiducials with it
    camera_clock_step,  ///< the frames' time stamps are 2 s ahead
    stage_clock_step,   ///< the stage's clock goes 2 s ahead; the camera's does not
    encoder_jump,       ///< 400 counts without motion
    hall_stuck,         ///< the Hall sensor's reading is constant
    heater_dead,        ///< the wire gets no current
    macro_jammed,       ///< the carriage does not move
};

/// A fault and its time, in session time.
struct Fault {
    FaultKind kind;       ///< what fails
    double from_s = 0.0;  ///< from when on
    double for_s = 1e9;   ///< how long; without end by default

    /// Whether it is in force at a time.
    bool is_on(TimeNs now_ns) const {
        return now_ns >= nanoseconds(from_s) && now_ns < nanoseconds(from_s + for_s);
    }
};

/// "hall_stuck".
std::string_view name_of(FaultKind kind);

/// All of them, in the order of the enumeration.
inline constexpr std::array fault_kinds{
    FaultKind::frames_dropped, FaultKind::frames_late,       FaultKind::camera_silent,
    FaultKind::image_frozen,   FaultKind::image_dark,        FaultKind::image_bright,
    FaultKind::tag_hidden,     FaultKind::camera_clock_step, FaultKind::stage_clock_step,
    FaultKind::encoder_jump,   FaultKind::hall_stuck,        FaultKind::heater_dead,
    FaultKind::macro_jammed};

/// Reads "KIND[:from_s=40][,for_s=2]". Throws InputError that names what is allowed.
Fault parse_fault(const std::string& text);

}  // namespace fidservo
