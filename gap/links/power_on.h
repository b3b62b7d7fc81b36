// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The common state of recordings that one rig made between power-on and power-off.
//
// A program that works on a rig may write one recording for each of its steps; the wire's memory and the
// encoder's count go on from one to the next. Such recordings are joined and judged as one.
//
// An incremental encoder counts from the position at power-on. If a recording states its zero, or all its
// positions lie in the travel and agree with the fiducials seen, its counts are positions on the rail.
// Otherwise the zero follows from the fiducials: it is the median, over all detections, of the tag's place on
// the plate, minus its place relative to the camera's axis, minus the platform's position by the Hall
// reading, minus the counts. That uses the rig file's camera and sensors, so that the zero is different under
// another hypothesis. Without fiducials positions are only relative.
#include "core/recording.h"

#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// Joins each recording to the one that it continues. A recording continues another one if it begins within
/// 0.1 s of the other's end (the longest pause over which the wire's state is followed), on the same clock,
/// over the same plate, near the same count, and under the same controllers. Recordings that overlap in time
/// are taken to have different clocks.
std::vector<Recording> joined(std::vector<Recording> recordings, const Rig& rig);

/// How the carriage's positions in a recording are known.
enum class PlacesFrom {
    recording,  ///< the recording states them, or they lie in the travel and nothing contradicts that
    tags,       ///< from the fiducials, up to an offset that every hypothesis finds anew
    nowhere     ///< not at all: ends of travel show only by what happens at them
};

/// Shifts a recording's encoder readings by whole counts so that they are positions in the rig's travel, if
/// these can be known.
/// @return how they are known
PlacesFrom refer_to_travel(Recording& recording, const Rig& rig);

}  // namespace fidservo::gap
