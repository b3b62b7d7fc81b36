// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which tag of the plate a detection is of.
#include "core/plate.h"
#include "core/recording.h"

#include <array>
#include <optional>

#include <Eigen/Core>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// Whether it is known which tags a recording's camera has before it: the rig has a camera, and the recording
/// or the rig file says what the plate is like.
bool shows_tags(const Recording& recording, const Rig& rig);

/// A tag of the plate that a recording was made over, which is the rig file's where the recording states no
/// other; empty for a tag that it does not have.
std::optional<PlateTag> plate_tag(const Recording& recording, const Rig& rig, int id);

/// Its corners on the plate, in the order in which detections list them, mm.
std::array<Eigen::Vector2d, 4> plate_corners_mm(const PlateTag& tag);

}  // namespace fidservo::gap
