// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera's lens from views of a flat target.
#include "calib/camera/lens_projection.h"
#include "calib/camera/plane_pose.h"
#include "calib/camera/target_view.h"
#include "core/camera/camera_geometry.h"
#include "core/result.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// Which numbers of a lens are meant, in the order of LensParameter.
using LensMask = std::array<bool, lens_parameters>;

/// Focal length, principal point and k1.
LensMask usual_lens();

/// What is fitted, and what is believed beforehand.
struct CameraCalibrationOptions {
    int width_px = 0;                        ///< of the images
    int height_px = 0;                       ///< of the images
    LensModel model = LensModel::plumb_bob;  ///< the lens's
    /// Which of the lens's parameters are fitted; the others keep the values of a lens without distortion.
    /// Empty: the usual ones, and the model's other coefficients as far as they improve the fit at 1 %.
    std::optional<LensMask> fitted;
    bool fit_focal_ratio = false;  ///< where `fitted` is empty
    bool fit_tag_scale = false;    ///< likewise
    /// What is believed beforehand, of that model; the iteration starts there. Empty: from the corners alone
    /// (calibration_start.h).
    std::optional<CameraGeometry> start;
    double extra_std_px = 0.0;  ///< of the corners, added to their covariances in squares
};

/// A tag's corners as seen minus as the calibrated camera shows them.
struct SightResidual {
    int tag_id;                               ///< which tag
    std::array<Eigen::Vector2d, 4> seen_px;   ///< its corners as they were measured
    std::array<Eigen::Vector2d, 4> error_px;  ///< seen less shown
    bool used;                                ///< false: it fits so badly that it was left out
};

/// A view's pose and what it leaves.
struct ViewFit {
    std::string name;                        ///< of the image
    PlanePose pose;                          ///< of the target before the camera
    Eigen::Matrix<double, 6, 6> covariance;  ///< of (rotation vector of R, t)
    double rms_px;                    ///< r.m.s. distance of the used corners from where they should be
    std::vector<SightResidual> tags;  ///< tag by tag
};

/// A camera as views of a target tell it.
struct CameraCalibration {
    CameraGeometry camera;   ///< the lens; rotation, tilt and distance are those of the first view
    LensMask fitted;         ///< which numbers of the lens were fitted
    double tag_scale = 1.0;  ///< of the tags' sides to those said, where that was fitted
    Eigen::Matrix<double, lens_parameters, lens_parameters> covariance;  ///< zero where not fitted
    std::vector<ViewFit> views;                                          ///< each one's pose and residuals
    double rms_px;       ///< r.m.s. distance of the used corners, as OpenCV counts the reprojection error
    double chi2;         ///< sum of squares of the residuals of the used tags in their own variances
    int freedom;         ///< what was measured less what was fitted
    double misfit;       ///< chi2 / freedom
    std::size_t unused;  ///< tags that were left out
    /// The views in the order of `views`, as they are without knowledge of the lens.
    std::vector<TargetView> seen;

    /// Standard error, in the parameter's own unit.
    double std_of(LensParameter parameter) const;
};

/// Bundle adjustment: weighted least squares of all measured directions of all tags' corners over the lens
/// and a pose a view, Q = R P + t, image of Q by core/camera/camera_geometry.h. Tags whose mean square
/// exceeds 16 times the median one are left out and the rest fitted again. Covariances are from the Jacobian,
/// times the misfit where that is above 1. Source: Zhang, A flexible new technique for camera calibration,
/// IEEE PAMI 22(11), 2000; Triggs et al., Bundle adjustment, a modern synthesis, 1999. Fails with
/// Reason::not_identifiable if no view has a tag or the views do not determine the lens at all (poorly
/// determined numbers are returned, with their standard errors), Reason::no_convergence.
Result<CameraCalibration> calibrate_camera(const std::vector<TargetView>& views,
                                           const CameraCalibrationOptions& options);

}  // namespace fidservo::calib
