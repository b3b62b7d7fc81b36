// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rectangles of the plate that a camera sees.
#include "core/camera/camera_geometry.h"
#include "src/inspect/recipe/clip.h"

namespace fidservo::inspect {

/// A rectangle along plate x and y that lies wholly in the image from camera position s: between the
/// pictures of the outermost pixels' centres. The whole image for a camera that looks straight down.
Box box_seen(const CameraGeometry& camera, double s_mm);

/// The smallest such rectangle that the whole image lies in.
Box box_around_seen(const CameraGeometry& camera, double s_mm);

}  // namespace fidservo::inspect
