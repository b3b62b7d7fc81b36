// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera-to-stage map: how a camera that rides along one axis sees a plate of known tags.
//
// Frames taken at rest at unknown positions s_i show tags at known plate places. With the projection of
// core/camera/camera_geometry.h and its intrinsics given,
//
//     corners_ik = project(camera, tag_k - (0, y), s_i) + noise,
//
// weighted least squares (Gauss-Newton, the s_i eliminated) gives distance, rotation and tilt of the camera
// against the plate, the direction of the stage's axis in the plate's frame, the first radial coefficient of
// the lens and the lateral offset y, all at once with their covariance. Distance and focal length act as one
// (their ratio is the scale), so the rig file's focal length is kept. The scale is that of the plate's pitch:
// no encoder enters.
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
    vision::CornerCovariance covariance_px2;  ///< of rank 4 where the camera was known
    /// Whether the refinement knew the camera, and so the bend of the tag's edges; else pictured_corners.h
    /// holds.
    bool camera_known = false;
};

/// The tags of one frame taken at rest.
using StageView = std::vector<SeenTag>;

/// The map's numbers, in the order of its covariance: the camera's (core/camera/camera_covariance.h), with
/// the distance where the views are, and where its foot is across the row.
enum MapValue : int {
    map_distance,  ///< mm, camera to plate, at the middle of the views
    map_rotation,  ///< rad, of the picture against the plate
    map_tilt_u,    ///< rad
    map_tilt_v,
    map_axis_y,  ///< rad, of the stage's axis in the plate
    map_axis_z,  ///< rad, towards the plate
    map_k1,
    map_y  ///< mm, plate y of the camera's foot at the middle of the views
};
inline constexpr int map_values = 8;

using MapCovariance = Eigen::Matrix<double, map_values, map_values>;
using MapNumbers = Eigen::Matrix<double, map_values, 1>;

struct StageMap {
    CameraGeometry camera;  ///< with all that was fitted; distance_mm as the rig file has it, at s = 0
    double middle_mm = 0.0;
    MapNumbers values = MapNumbers::Zero();
    MapCovariance covariance = MapCovariance::Zero();
    CameraCovariance camera_covariance = CameraCovariance::Zero();  ///< of camera's numbers
    std::vector<double> s_mm;                                       ///< of each view
    std::vector<double> s_std_mm;
    double misfit = 1.0;   ///< chi-square over its degrees of freedom
    double freedom = 0.0;  ///< degrees of freedom
    bool fits = true;      ///< whether that can be noise, at 0.1 %; if not, the covariance is widened by it
    double residual_rms_px = 0.0;

    double std(MapValue value) const { return std::sqrt(covariance(value, value)); }
    /// Length in the image per plate length at the middle of the views, px/mm.
    double scale_px_per_mm() const { return camera.focal_px / values(map_distance); }
    double relative_scale_std() const { return std(map_distance) / values(map_distance); }
    /// Angle of the stage's axis in the image: what tells a turned camera from a turned plate, rad.
    double image_axis_rad() const { return values(map_rotation) + values(map_axis_y); }
    double image_axis_std_rad() const;
};

/// @param nominal  intrinsics, and k1 to start from
/// Fails with Reason::not_identifiable if the views are too few or too alike (fewer than 4 views, tags over
/// less than a tenth of the image's width, motion over less than a tenth of it), with
/// Reason::no_convergence if the iteration does not end.
Result<StageMap> fit_stage_map(const CameraGeometry& nominal, std::span<const StageView> views);

/// A view that was not fitted, against the map.
struct ViewCheck {
    double s_mm;
    double s_std_mm;  ///< of noise and map
    double chi_square;
    double freedom;
    double rms_px;            ///< of the corners' coordinates
    double promised_rms_px;   ///< what noise and the map's covariance make of it
    double worst_normalised;  ///< largest residual of a corner's coordinate over its standard deviation
    double worst_px;          ///< that residual
};

/// Fits the view's position alone, weighted by its noise; chi_square counts the map's covariance too.
ViewCheck check_view(const StageMap& map, const StageView& view);

/// Residuals of a view at position s: corners seen minus corners expected, px; tag by tag.
std::vector<std::array<Eigen::Vector2d, 4>> residuals_px(const StageMap& map, const StageView& view,
                                                         double s_mm);

}  // namespace fidservo::calib
