// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of the rig, by what shows an effect on them.

namespace fidservo::plant {

/// The part of the rig that an effect changes. By it a diagnosis knows which signals show the effect.
enum class Part {
    carriage,  ///< how it moves: drive, friction, mechanics
    encoder,   ///< how the carriage is read
    wire,      ///< heater and hysteresis
    platform,  ///< how it swings on its flexure
    hall,      ///< how the platform is read
    view,      ///< where the camera sees what, and when
    shutter,   ///< when it sees each row: the shape of a tag that moves
    exposure,  ///< over how long: where a tag that moves is seen, and its looks
    image,     ///< the looks alone
};

constexpr bool is_of_platform(Part part) {
    return part == Part::wire || part == Part::platform || part == Part::hall;
}

/// Whether only who has the frames themselves can see it.
constexpr bool is_of_frames(Part part) {
    return part == Part::shutter || part == Part::exposure || part == Part::image;
}

constexpr bool is_of_camera(Part part) {
    return part == Part::view || is_of_frames(part);
}

}  // namespace fidservo::plant
