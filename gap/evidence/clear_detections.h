// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which detections say where a tag was.
#include "core/recording.h"

#include <set>
#include <span>
#include <utility>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// Frame and tag.
using TagsInFrames = std::set<std::pair<TimeNs, int>>;

/// Whether some of a recording's corners are known to be refined. Beside these, the others are not judged.
bool refines_corners(const Recording& recording);

/// Those that look smeared, along their motion or whatever it is, by more than 0.15 cells w: the squares of
/// their edges' widths differ by w^2 / 12, or some edges are too wide to be measured and others are not.
TagsInFrames smeared_tags(const Recording& recording);

/// Takes out of a recording the detections that say little of where the tag was: those of frames in which it
/// moves by more than 0.15 cells while they are exposed, by the carriage's velocity (one value a row), by
/// where the frames before and after show it and by how it looks; where frames were measured, those that one
/// of these frames does not show; those nearer than half a cell to the image's border, which may have cut it;
/// and, of a recording that refines corners, those that could not be refined.
void drop_unclear(Recording& recording, std::span<const double> velocity_mm_per_s, const Rig& rig,
                  double exposure_s, const TagsInFrames& smeared);

}  // namespace fidservo::gap
