// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether the images of tags are sheared by their motion, as by a rolling shutter.
//
// A common readout time r is fitted to all detections of tags that are also in the frames before and after,
// by the corners' components except that along the stage's motion:
//
//     error of a corner = r v (row of the corner - mean row of the corners) / (height - 1)
//
// with v the tag's velocity in the image, px/s, from the frames before and after.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether that explains 70 % or more of the squared errors in the tags' shapes.
bool tags_are_sheared(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
