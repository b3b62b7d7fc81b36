// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether tags are sheared by how they move: what frames look like whose rows are exposed one after the
// other.
//
// Over all detections of tags that the frames before and after show, the turned values but the first one
// (which moves with the stage) are fitted by one readout time r:
//
//     error of a corner = r v (row of the corner - mean row of the corners) / (height - 1)
//
// with v how the tag moves in the image, px/s, by the frames before and after.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether that takes 70 % of the squared errors or more of the shapes of tags.
bool tags_are_sheared(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
