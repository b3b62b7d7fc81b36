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

/// A selection of the lens's parameters, in the order of LensParameter.
using LensMask = std::array<bool, lens_parameters>;

/// The usual selection: focal length, principal point and k1.
LensMask usual_lens();

/// What is fitted, and from where the iteration starts.
struct CameraCalibrationOptions {
    int width_px = 0;                        ///< of the images
    int height_px = 0;                       ///< of the images
    LensModel model = LensModel::plumb_bob;  ///< the lens's model
    /// Which of the lens's parameters are fitted; the others keep the values of a lens without distortion.
    /// Empty: the usual ones, and the model's other coefficients as far as they improve the fit at 1 %.
    std::optional<LensMask> fitted;
    bool fit_focal_ratio = false;  ///< used where `fitted` is empty
    bool fit_tag_scale = false;    ///< used where `fitted` is empty
    /// A lens of that model from which the iteration starts. Empty: start values come from the corners alone
    /// (calibration_start.h).
    std::optional<CameraGeometry> start;
    double extra_std_px = 0.0;  ///< standard deviation added in quadrature to the corners' own
};

/// The residuals of a tag's corners: seen minus predicted by the calibrated camera.
struct SightResidual {
    int tag_id;                               ///< which tag
    std::array<Eigen::Vector2d, 4> seen_px;   ///< its corners as they were measured
    std::array<Eigen::Vector2d, 4> error_px;  ///< seen minus predicted
    bool used;                                ///< false: it fits so badly that it was left out
};

/// A view's pose and its residuals.
struct ViewFit {
    std::string name;                        ///< of the image
    PlanePose pose;                          ///< of the target before the camera
    Eigen::Matrix<double, 6, 6> covariance;  ///< of (rotation vector of R, t)
    double rms_px;                    ///< r.m.s. distance of the used corners from their predicted places
    std::vector<SightResidual> tags;  ///< residuals of each tag
};

/// A camera calibrated from views of a target.
struct CameraCalibration {
    CameraGeometry camera;   ///< the lens; rotation, tilt and distance are those of the first view
    LensMask fitted;         ///< which numbers of the lens were fitted
    double tag_scale = 1.0;  ///< the tags' sides relative to their stated ones, where that was fitted
    Eigen::Matrix<double, lens_parameters, lens_parameters> covariance;  ///< zero where not fitted
    std::vector<ViewFit> views;                                          ///< pose and residuals of each view
    /// r.m.s. distance of the used corners from their predicted places, OpenCV's reprojection error.
    double rms_px;
    double chi2;         ///< sum of squares of the used tags' residuals, each in its own variance
    int freedom;         ///< degrees of freedom: measured directions minus fitted numbers
    double misfit;       ///< chi2 / freedom
    std::size_t unused;  ///< tags that were left out
    /// The views in the order of `views`, as they were measured without knowledge of the lens.
    std::vector<TargetView> seen;

    /// Standard error, in the parameter's own unit.
    double std_of(LensParameter parameter) const;
};

/// Bundle adjustment: weighted least squares of the corners of all tags (in the directions that were
/// measured) over the lens and one pose per view, Q = R P + t, image of Q by core/camera/camera_geometry.h.
/// Tags whose mean square exceeds 16 times the median one are left out and the rest fitted again. Covariances
/// are from the Jacobian, times the misfit where that is above 1. Source: Zhang, A flexible new technique for
/// camera calibration, IEEE PAMI 22(11), 2000; Triggs et al., Bundle adjustment, a modern synthesis, 1999.
/// Fails with Reason::not_identifiable if no view has a tag or the views do not determine the lens at all
/// (poorly determined numbers are returned, with their standard errors), Reason::no_convergence.
Result<CameraCalibration> calibrate_camera(const std::vector<TargetView>& views,
                                           const CameraCalibrationOptions& options);

}  // namespace fidservo::calib
