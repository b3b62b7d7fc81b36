// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Selects the detections that give a tag's position reliably.
#include "core/recording.h"

#include <set>
#include <span>
#include <utility>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// Pairs of a frame's time and a tag's id.
using TagsInFrames = std::set<std::pair<TimeNs, int>>;

/// Whether a recording marks any detection's corners as refined. If so, detections whose corners could not be
/// refined are not judged.
bool refines_corners(const Recording& recording);

/// Tags whose images are smeared in one direction, by motion or anything else, over more than w = 0.15 cells:
/// the variances of their edges differ by more than w^2 / 12, or some but not all edges are too wide to be
/// measured.
TagsInFrames smeared_tags(const Recording& recording);

/// Removes the detections whose tag positions are unreliable:
/// - those whose tag moves by more than 0.15 cells during the exposure, by the carriage's velocity (one value
///   for each row), by its positions in the neighbouring frames, or by its appearance (`smeared`);
/// - if frames were measured, those whose tag is missing in the frame before or after;
/// - those nearer than half a cell to the image's border, which may cut the tag;
/// - in a recording that refines corners, those that could not be refined.
void drop_unclear(Recording& recording, std::span<const double> velocity_mm_per_s, const Rig& rig,
                  double exposure_s, const TagsInFrames& smeared);

}  // namespace fidservo::gap
