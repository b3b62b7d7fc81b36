// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recordings of one rig between power-on and power-off: what they share.
//
// A program that works on a rig may write one recording for each of its steps; the wire's memory and the
// encoder's count go on from one to the next. Such recordings are joined and judged as one.
//
// An incremental encoder counts from the position at power-on. Where a recording states its zero, or all its
// positions lie in the travel and agree with the fiducials seen, its counts are positions on the rail. A zero
// that was measured was measured by the rig file, so that a hypothesis may find another one. Otherwise the
// fiducials give the zero: the median over all detections of the tag's place on the plate, minus where it is
// seen from the camera's axis, minus the platform by the Hall reading, minus the counts. Without fiducials
// positions are only relative.
#include "core/recording.h"

#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// Joins each recording to the one that it continues. It continues another one if it begins within 0.1 s
/// after its end (the longest pause over which the wire's state is followed), on the same clock, over the
/// same plate, near the same count, and under the same controllers. Recordings that cover the same time as
/// another one count as being on a clock of their own.
std::vector<Recording> joined(std::vector<Recording> recordings, const Rig& rig);

/// How the carriage's positions in a recording are known.
enum class PlacesFrom {
    recording,  ///< the recording states them, or they lie in the travel and nothing contradicts that
    tags,       ///< from the fiducials, up to an offset that every hypothesis finds anew
    nowhere     ///< not at all: ends of travel show only by what happens at them
};

/// Shifts a recording's encoder by whole counts to make its readings positions in the rig's travel, as far as
/// that is known.
PlacesFrom refer_to_travel(Recording& recording, const Rig& rig);

}  // namespace fidservo::gap
