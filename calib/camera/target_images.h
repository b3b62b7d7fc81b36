// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Calibrates a camera's lens from images of a flat target.
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
    std::string name;                 ///< the image's file, for messages
    cv::Mat grey;                     ///< CV_8UC1
    std::vector<TagDetection> found;  ///< the detector's tags
};

/// The target's tags in an image, refined. Tags that cannot be refined, that are not on the target, or that
/// appear twice are left out; tags that are too small for a refinement keep the detected corners.
TargetView view_of(const TargetImage& image, const std::vector<PlateTag>& target,
                   const vision::RefinementOptions& options);

/// How images are measured and the lens is fitted.
struct ImageCalibrationOptions {
    CameraCalibrationOptions lens;  ///< of the fit
    /// The camera's noise, for the weights of pixels.
    vision::GreyNoise noise = vision::RefinementOptions{}.noise;
};

/// Alternates refinement and calibration: first every tag is refined with a perspective of its own; then tags
/// are refined with each view's tilt and the lens's distortion from the last calibration, and the lens is
/// calibrated again, until that changes the lens by less than a tenth of its standard errors. Views of fewer
/// than two tags are left out. Fails as calibrate_camera() does.
Result<CameraCalibration> calibrate_camera(const std::vector<TargetImage>& images,
                                           const std::vector<PlateTag>& target,
                                           const ImageCalibrationOptions& options);

}  // namespace fidservo::calib
