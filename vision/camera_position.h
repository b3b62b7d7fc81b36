// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a frame to where the camera is.
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

/// Camera position with all that the fit says.
struct PositionFit {
    CameraPosition position;  ///< by this tag
    double y_std_mm;          ///< one standard deviation
    double
        rotation_rad;  ///< of the tag on the plate against its nominal angle, from x towards y: a diagnosis
    double rotation_std_rad;  ///< one standard deviation
    double residual_rms_px;   ///< of the eight corner coordinates against the tag so placed and turned
    RefinedTag tag;           ///< what it was fitted to
};

/// Camera position s and offset y at which the image of the tag's centre c is the picture of its nominal
/// place:
///
///     back_project(c, s) + (0, y) = nominal centre,
///
/// which is linear in both. Of a tag whose corners alone are known (its `explained` is 0), c is the image of
/// the mean of the corners on the plate. Their standard deviations are propagated from the centre's
/// covariance through the back projection; plate and geometry count as exact. The rotation is the least
/// squares one between the corners, back-projected, and the nominal ones about the centre, and does not enter
/// the position.
PositionFit fit_position(const CameraGeometry& camera, const PlateTag& nominal, const RefinedTag& seen);

/// What is known beforehand, and what counts as hidden.
struct LocateOptions {
    /// Where the stage believes the camera is, to within a third of a tag's cell. Only used to tell why the
    /// expected tag is not found where no other tag tells where to look.
    std::optional<double> predicted_s_mm = {};
    double least_explained = enough_to_measure;  ///< below: occluded
    double most_saturated = 0.01;  ///< share of the tag's area at the grey level 255; above: glare
    GreyNoise noise = RefinementOptions{}.noise;  ///< of the camera
    double moved_mm = 0.0;                        ///< by the stage during the exposure
};

/// What refine_tag() should know of a picture of `tag` by this camera.
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
