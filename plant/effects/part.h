// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of the rig, divided by the signals in which an effect on them shows.

namespace fidservo::plant {

/// The part of the rig that an effect changes. From it a diagnosis knows in which signals the effect shows.
enum class Part {
    carriage,  ///< the carriage's motion: drive, friction, mechanics
    encoder,   ///< the reading of the carriage's position
    wire,      ///< heater and hysteresis
    platform,  ///< the platform's oscillation on its flexure
    hall,      ///< the reading of the platform's position
    view,      ///< where and when the camera sees a point
    shutter,   ///< when each row is exposed, which shears a moving tag
    exposure,  ///< the exposure time: it shifts and blurs a moving tag
    image,     ///< the brightness and sharpness of images only
};

constexpr bool is_of_platform(Part part) {
    return part == Part::wire || part == Part::platform || part == Part::hall;
}

/// Whether an effect shows only in the frames themselves, not in the tags' positions alone.
constexpr bool is_of_frames(Part part) {
    return part == Part::shutter || part == Part::exposure || part == Part::image;
}

constexpr bool is_of_camera(Part part) {
    return part == Part::view || is_of_frames(part);
}

}  // namespace fidservo::plant
