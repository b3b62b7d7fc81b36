// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera-to-stage map: how a camera that moves along one axis sees a plate of known tags.
//
// Frames taken at rest at unknown positions s_i show tags at known plate places. With the projection of
// core/camera/camera_geometry.h and its intrinsics given,
//
//     corners_ik = project(camera, tag_k - (0, y), s_i) + noise,
//
// weighted least squares (Gauss-Newton, the s_i eliminated) gives distance, rotation and tilt of the camera
// against the plate, the direction of the stage's axis in the plate's frame, the first radial coefficient of
// the lens and the lateral offset y, all at once with their covariance. Distance and focal length cannot be
// separated (their ratio is the scale); therefore the rig file's focal length is kept. The scale follows from
// the pitch of the tags on the plate; the encoder is not used.
#include "core/camera/camera_covariance.h"
#include "core/camera/camera_geometry.h"
#include "core/plate.h"
#include "core/result.h"
#include "vision/tags/tag_refinement.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fidservo::calib {

/// One tag in a frame.
struct SeenTag {
    PlateTag nominal;
    std::array<Eigen::Vector2d, 4> corners_px;
    /// Rank deficient (rank 4) where the refinement used the camera.
    vision::CornerCovariance covariance_px2;
    /// Whether the refinement knew the camera, and so the distortion of the tag's edges; otherwise its
    /// corners are those of pictured_corners.h.
    bool camera_known = false;
};

/// The tags of one frame taken at rest.
using StageView = std::vector<SeenTag>;

/// Indices of the map's numbers in its covariance: those of core/camera/camera_covariance.h, with the
/// distance at the middle of the views, and the lateral offset of the camera's foot.
enum MapValue : int {
    map_distance,  ///< mm, from camera to plate, at the middle of the views
    map_rotation,  ///< rad, of the image against the plate
    map_tilt_u,    ///< rad
    map_tilt_v,
    map_axis_y,  ///< rad, of the stage's axis in the plate's plane
    map_axis_z,  ///< rad, of the stage's axis towards the plate
    map_k1,
    map_y  ///< mm, plate y of the camera's foot at the middle of the views
};
inline constexpr int map_values = 8;

using MapCovariance = Eigen::Matrix<double, map_values, map_values>;
using MapNumbers = Eigen::Matrix<double, map_values, 1>;

struct StageMap {
    CameraGeometry camera;  ///< with all fitted numbers; distance_mm is that at s = 0, as in the rig file
    double middle_mm = 0.0;
    MapNumbers values = MapNumbers::Zero();
    MapCovariance covariance = MapCovariance::Zero();
    CameraCovariance camera_covariance = CameraCovariance::Zero();  ///< covariance of the camera's numbers
    std::vector<double> s_mm;                                       ///< camera position of each view
    std::vector<double> s_std_mm;
    double misfit = 1.0;   ///< chi-square over its degrees of freedom
    double freedom = 0.0;  ///< degrees of freedom
    /// Whether the misfit can be noise, at a level of 0.1 %; if not, the covariance is widened by it.
    bool fits = true;
    double residual_rms_px = 0.0;

    double std(MapValue value) const { return std::sqrt(covariance(value, value)); }
    /// Length in the image per plate length at the middle of the views, px/mm.
    double scale_px_per_mm() const { return camera.focal_px / values(map_distance); }
    double relative_scale_std() const { return std(map_distance) / values(map_distance); }
    /// Angle of the stage's axis in the image, rad, which distinguishes a rotated camera from a rotated
    /// plate.
    double image_axis_rad() const { return values(map_rotation) + values(map_axis_y); }
    double image_axis_std_rad() const;
};

/// @param nominal  gives the intrinsics, and a start value for k1
/// @return fails with Reason::not_identifiable if the views are too few or too similar (fewer than 4 views,
/// tags over less than a tenth of the image's width, motion over less than a tenth of it); with
/// Reason::no_convergence if the iteration does not converge
Result<StageMap> fit_stage_map(const CameraGeometry& nominal, std::span<const StageView> views);

/// A view that was not used in the fit, compared with the map.
struct ViewCheck {
    double s_mm;
    double s_std_mm;  ///< from the noise and the map's uncertainty
    double chi_square;
    double freedom;
    double rms_px;            ///< r.m.s. residual of the corners' coordinates
    double promised_rms_px;   ///< expected r.m.s. residual, from noise and the map's covariance
    double worst_normalised;  ///< largest residual of a corner's coordinate over its standard deviation
    double worst_px;          ///< the same residual, px
};

/// Fits only the view's position, weighted by its noise; chi_square includes the map's covariance.
ViewCheck check_view(const StageMap& map, const StageView& view);

/// Residuals of a view at position s: corners seen minus corners expected, px; tag by tag.
std::vector<std::array<Eigen::Vector2d, 4>> residuals_px(const StageMap& map, const StageView& view,
                                                         double s_mm);

}  // namespace fidservo::calib
