// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether the images of tags are sheared by their motion, as by a rolling shutter.
//
// A common readout time r, s, is fitted to the errors of all detections of tags that the frames before and
// after show, too. The component along the stage's motion is left out of the fit:
//
//     error of a corner = r v (row of the corner - mean row of the corners) / (height - 1)
//
// with v the tag's velocity in the image, px/s, from the frames before and after.
#include "gap/evidence.h"

namespace fidservo::gap {

/// Whether this model explains 70 % or more of the squared errors, the component along the stage's motion
/// left out.
bool tags_are_sheared(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
