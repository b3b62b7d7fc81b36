// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A camera's intrinsics as other programs keep them, in YAML: ROS (camera_calibration, camera_info_manager,
// camera_calibration_parsers), OpenCV, kalibr, EuRoC. Pixel centres lie at integer coordinates in all of
// them.
#include "core/camera/camera_geometry.h"

#include <filesystem>
#include <string>

namespace fidservo {

/// A camera's intrinsics as such a file states them.
struct CameraInfo {
    std::string camera_name;             ///< as in the file; may be empty
    int width_px;                        ///< of the image
    int height_px;                       ///< of the image
    Eigen::Vector2d focal_px;            ///< f_x, f_y
    Eigen::Vector2d principal_point_px;  ///< (u0, v0)
    LensDistortion distortion;           ///< plumb_bob
};

/// The camera's intrinsics without its place.
CameraInfo camera_info_of(const CameraGeometry& camera, const std::string& camera_name);

/// A camera with other intrinsics; its mounting stays.
CameraGeometry with_intrinsics(CameraGeometry camera, const CameraInfo& info);

/// Reads a file; its keys tell whose it is:
///   camera_matrix   ROS, and OpenCV's samples: image_width, image_height, distortion_coefficients; matrices
///   as rows,
///                   cols, data. Rectification and projection concern rectified images: their sizes are
///                   checked, their numbers not used.
///   K or k          ROS's message sensor_msgs/CameraInfo: width, height, D or d
///   cam0            a kalibr camchain of one camera: intrinsics, resolution, distortion_coeffs
///   intrinsics      EuRoC's sensor.yaml: resolution, distortion_coefficients
/// Distortion is Brown's (plumb_bob, radtan, radial-tangential), with none, four (k1, k2, p1, p2) or five
/// coefficients, more if they are 0; or equidistant, also called fisheye, with four. An empty model, or
/// `none`, without coefficients is that of a camera without distortion. Keys beyond these are passed over.
/// Throws InputError that names file, line, key and value; also where the principal point is outside the
/// image, or where the matrix is not that of the image: binning, roi.
CameraInfo load_camera_info(const std::filesystem::path& file);

/// The file's text; what load_camera_info() makes of it is the same to the last bit. Rectification is none,
/// and the projection is the camera matrix.
std::string camera_info_text(const CameraInfo& info);

}  // namespace fidservo
