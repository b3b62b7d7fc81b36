// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera's lens from images of a flat target.
#include "calib/camera/camera_calibration.h"
#include "calib/camera/target_view.h"
#include "core/detection.h"
#include "core/result.h"
#include "vision/grey_noise.h"
#include "vision/tags/tag_refinement.h"

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::calib {

/// An image with what the detector found in it.
struct TargetImage {
    std::string name;                 ///< for people: the image's file
    cv::Mat grey;                     ///< CV_8UC1
    std::vector<TagDetection> found;  ///< by the detector
};

/// The target's tags in an image, refined; those that cannot be refined, that the target does not have and
/// that are there twice are left out. Tags too small for a refinement are taken as they were found.
TargetView view_of(const TargetImage& image, const std::vector<PlateTag>& target,
                   const vision::RefinementOptions& options);

/// How images are measured and the lens is fitted.
struct ImageCalibrationOptions {
    CameraCalibrationOptions lens;  ///< of the fit
    vision::GreyNoise noise =
        vision::RefinementOptions{}.noise;  ///< of the camera, for the weights of pixels
};

/// Refinement and calibration in turn: first every tag with a perspective of its own; then, with each view's
/// tilt and the lens's distortion known, tags are refined again by them, and the lens with what was measured
/// then, until that changes the lens by less than a tenth of its standard errors. Views of fewer than two
/// tags are left out. Fails as calibrate_camera() does.
Result<CameraCalibration> calibrate_camera(const std::vector<TargetImage>& images,
                                           const std::vector<PlateTag>& target,
                                           const ImageCalibrationOptions& options);

}  // namespace fidservo::calib
