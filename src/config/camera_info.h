#pragma once
// A camera's intrinsics as ROS keeps them: the YAML file of camera_calibration and camera_info_manager
// (camera_calibration_parsers). Pixel centres lie at integer coordinates there too.
#include "core/camera_geometry.h"

#include <filesystem>
#include <string>

namespace fidservo {

/// What such a file says of the image as the camera gives it.
struct CameraInfo {
    std::string camera_name;
    int width_px;
    int height_px;
    Eigen::Vector2d focal_px;  ///< f_x, f_y
    Eigen::Vector2d principal_point_px;
    LensDistortion distortion;
};

/// The camera's intrinsics without its place.
CameraInfo camera_info_of(const CameraGeometry& camera, const std::string& camera_name);

/// The same intrinsics in a camera whose place is another one's.
CameraGeometry with_intrinsics(CameraGeometry camera, const CameraInfo& info);

/// Reads the file. Rectification and projection concern rectified images: their sizes are checked, their
/// numbers not used. Keys beyond ROS's own are passed over. Throws InputError that names file, line, key and
/// value; the distortion models are plumb_bob and
/// equidistant, which may be called fisheye.
CameraInfo load_camera_info(const std::filesystem::path& file);

/// The file's text; what load_camera_info() makes of it is the same to the last bit. Rectification is none,
/// and the projection is the camera matrix.
std::string camera_info_text(const CameraInfo& info);

}  // namespace fidservo
