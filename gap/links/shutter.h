// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera's exposure and readout times as observed in its frames, without a fit.
//
//     exposure  T^2 = 12 (variance of an edge across the motion - variance of one along it) / speed^2
//     readout   displacement of a tag's lower corners against its upper ones along the motion, over speed
//               times the share of the image's rows between them
//
// each the median over the sightings of tags that move by more than 300 px/s.
#include "core/recording.h"
#include "gap/links/image_link.h"

#include <span>

namespace fidservo::gap {

struct Shutter {
    double exposure_s;  ///< the rig file's, or the observed one where that is longer
    double readout_s;   ///< from the first row's exposure to the last one's; 0 where too few tags move
};

/// @param images  measured appearances, one entry for each recording
Shutter seen_shutter(std::span<const Recording> recordings, std::span<const ImageRun> images,
                     const CameraParameters& camera);

}  // namespace fidservo::gap
