// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recordings of one rig between switching it on and off: what they share.
//
// A program that works on a rig writes a recording for each of its steps; the wire remembers and the encoder
// counts on from one to the next. Such recordings are judged as the one that they are.
//
// An incremental encoder counts from wherever the power came on. Where a recording states its zero, or all
// its places lie in the travel and agree with the fiducials seen, its counts are places; a zero that was
// measured was measured by the rig file, so that a hypothesis may find another one. Otherwise the fiducials
// give the zero: a tag's place on the plate less where it is seen from the camera's axis, less the
// platform by the Hall reading, less the counts; the median over all detections. Without fiducials places are
// relative.
#include "core/recording.h"

#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// Recordings that go on where another one ended, put together with it; the others as they are. One goes on
/// where another ended if it begins within 0.1 s, the longest pause over which the wire's state is followed,
/// on the same clock, which no other one contradicts by covering the same time, over the same plate, near the
/// same count, under the same controllers.
std::vector<Recording> joined(std::vector<Recording> recordings, const Rig& rig);

/// From what the carriage's places in a recording are known.
enum class PlacesFrom {
    recording,  ///< by the recording, or it lies in the travel and nothing contradicts
    tags,       ///< by the fiducials: up to an offset that every hypothesis finds anew
    nowhere     ///< not at all: ends of travel show only by what happens there
};

/// Refers a recording's encoder to the rig's travel, by whole counts, as far as that is known.
PlacesFrom refer_to_travel(Recording& recording, const Rig& rig);

}  // namespace fidservo::gap
