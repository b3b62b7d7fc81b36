// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which tags the camera sees from a position, and which of them is used for measuring. Pure geometry.
#include "core/camera/camera_geometry.h"
#include "core/plate.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace fidservo::vision {

/// Corners of a tag's black border on the plate in mm, in the order of detections.
std::array<Eigen::Vector2d, 4> corners_mm(const PlateTag& tag);

/// Tags whose border and white quiet zone (one cell all around) lie wholly in the image at camera position s,
/// sorted by their distance from the optical axis, then by id.
std::vector<PlateTag> visible_tags(const CameraGeometry& camera, const Plate& plate, double s_mm);

/// The tag for measuring from position s: the first of visible_tags(). Empty if there is none.
std::optional<PlateTag> tag_to_use(const CameraGeometry& camera, const Plate& plate, double s_mm);

/// Camera positions from which a tag is wholly in view.
struct ViewRange {
    double low_mm, high_mm;
};

/// The range of camera positions for a tag. The stage moves along x alone: empty for a tag whose row lies
/// outside the image's height, or for one that is larger than the image.
std::optional<ViewRange> view_range(const CameraGeometry& camera, const PlateTag& tag);

/// Whether the tag's row is within the image's height, so that the tag can be seen from some position along
/// x.
bool row_is_reachable(const CameraGeometry& camera, const PlateTag& tag);

/// The tags of a plate whose rows are within the image's height, in the plate's order.
std::vector<PlateTag> reachable_rows(const CameraGeometry& camera, const Plate& plate);

/// The plate's tag with this id; empty if there is none.
std::optional<PlateTag> find_tag(const Plate& plate, int tag_id);

}  // namespace fidservo::vision
