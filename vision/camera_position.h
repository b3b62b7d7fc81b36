// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the tags in a frame to the camera's position.
#include "core/camera/camera_geometry.h"
#include "core/detection.h"
#include "core/plate.h"
#include "core/result.h"
#include "vision/camera.h"
#include "vision/tags/tag_refinement.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace fidservo::vision {

/// A camera position with the quality of the fit.
struct PositionFit {
    CameraPosition position;  ///< the position by this tag
    double y_std_mm;          ///< standard deviation of the position's y_mm
    /// Rotation of the tag on the plate from its nominal angle, from x towards y; for diagnosis only.
    double rotation_rad;
    double rotation_std_rad;  ///< standard deviation of the rotation
    double residual_rms_px;   ///< of the eight corner coordinates from those of the fitted tag
    RefinedTag tag;           ///< the measured tag to which the position was fitted
};

/// Camera position s and offset y at which the image of the tag's centre c is the picture of its nominal
/// place:
///
///     back_project(c, s) + (0, y) = nominal centre,
///
/// which is linear in both. Of a tag whose corners alone are known (its `explained` is 0), c is the image of
/// the mean of the corners on the plate. The standard deviations of s and y are propagated from the centre's
/// covariance through the back projection; the plate and the camera's geometry count as exact. The rotation
/// is the least squares one between the corners, back-projected, and the nominal ones about the centre, and
/// does not enter the position.
PositionFit fit_position(const CameraGeometry& camera, const PlateTag& nominal, const RefinedTag& seen);

/// Prior knowledge for locating the camera, and thresholds for hidden and saturated tags.
struct LocateOptions {
    /// The stage's own estimate of the camera's position, good to a third of a tag's cell. It only serves to
    /// find the reason for a failure: where the expected tag should be, if no other tag in the frame tells.
    std::optional<double> predicted_s_mm = {};
    double least_explained = enough_to_measure;  ///< RefinedTag::explained below this: occluded
    /// Glare if more than this fraction of the tag's area is at grey level 255.
    double most_saturated = 0.01;
    GreyNoise noise = RefinementOptions{}.noise;  ///< of the camera
    double moved_mm = 0.0;                        ///< the stage's motion during the exposure
};

/// The options of refine_tag() for a tag seen by this camera.
RefinementOptions refinement_of(const CameraGeometry& camera, const PlateTag& tag, const TagDetection& found,
                                const LocateOptions& options);

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
