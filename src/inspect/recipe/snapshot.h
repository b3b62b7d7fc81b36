// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An image taken at rest, with its fiducials and the camera position that follows from them.
#include "core/plate.h"
#include "core/result.h"
#include "vision/camera.h"
#include "vision/features/rest_image.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <vector>

namespace fidservo::inspect {

struct Snapshot {
    vision::RestImage image;  ///< its axis is counted from the site's fiducial at its nominal place
    std::vector<vision::RefinedTag> tags;  ///< all tags that were completely visible and belong to the plate
};

/// Finds the plate's fiducials, and where the camera was by the one that is named. Fails as
/// vision::locate_camera: no_tag, wrong_tag, several_tags, occluded, glare.
Result<Snapshot> read_snapshot(const vision::Frame& frame, const CameraParameters& camera,
                               const Plate& nominal, int tag_id, vision::TagDetector& detector);

}  // namespace fidservo::inspect
