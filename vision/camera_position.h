#pragma once
// From a frame to where the camera is.
#include "core/camera_geometry.h"
#include "core/detection.h"
#include "core/failure.h"
#include "core/plate.h"
#include "vision/camera.h"
#include "vision/tag_refinement.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace fidservo::vision {

/// Camera position with all that the fit says.
struct PositionFit {
    CameraPosition position;
    double y_std_mm;
    double rotation_rad;  ///< of the tag against its nominal angle, from u towards v
    double rotation_std_rad;
    double residual_rms_px;  ///< of the eight corner coordinates against the fit
    RefinedTag tag;          ///< what it was fitted to
};

/// Least squares of a tag's four corners against the projection of its nominal corners, over camera position
/// s, the offset y, and a rotation phi of the image about the optical axis:
///
///     (u, v) = (u0, v0) + R(phi) (P_k - (s, y)) f / Z
///
/// Standard deviations are propagated from the corners' joint covariance; plate and geometry count as exact.
PositionFit fit_position(const CameraGeometry& camera, const PlateTag& nominal, const RefinedTag& seen);

struct LocateOptions {
    /// Where the stage believes the camera is, to within a third of a tag's cell. Only used to tell why the
    /// expected tag is not found where no other tag tells where to look.
    std::optional<double> predicted_s_mm;
    double least_explained = 0.9;  ///< of every border edge's length; below: occluded
    double most_saturated = 0.01;  ///< share of the tag's area at the grey level 255; above: glare
};

/// Where the camera was when the frame was taken, by the tag that is expected in view.
/// Fails with
///   no_tag        nothing was found
///   wrong_tag     tags were found, but not the expected one (the text tells which, and which of them are not
///   on
///                 the plate), or the expected tag is not on the plate
///   several_tags  the expected id is there more than once
///   occluded      a border edge is partly hidden, or so much of the tag that it cannot be read
///   glare         part of the tag is saturated, or part of an image without the tag
Result<PositionFit> locate_camera(const CameraGeometry& camera, const Plate& nominal, const Frame& frame,
                                  const std::vector<TagDetection>& found, int expected_tag_id,
                                  const LocateOptions& options = {});

}  // namespace fidservo::vision
