// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which tag of the plate a detection shows.
#include "core/plate.h"
#include "core/recording.h"
#include "gap/evidence.h"

#include <array>
#include <optional>

#include <Eigen/Core>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// Whether it is known which tags a recording's camera can see: the rig has a camera, and the recording or
/// the rig file describes the plate.
bool shows_tags(const Recording& recording, const Rig& rig);

/// A tag of the plate over which a recording was made, which is the rig file's unless the recording states
/// another one; empty if the plate does not have the tag.
std::optional<PlateTag> plate_tag(const Recording& recording, const Rig& rig, int id);

/// A tag's corners on the plate, in the order in which detections list them, mm.
std::array<Eigen::Vector2d, corner_count> plate_corners_mm(const PlateTag& tag);

}  // namespace fidservo::gap
