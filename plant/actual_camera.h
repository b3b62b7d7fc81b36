#pragma once
// The camera as it is, as one geometry: the rig file's with the deviation on top.
#include "core/camera_geometry.h"
#include "plant/camera.h"

namespace fidservo::plant {

/// Focal length c f and radial distortion k1 + k; the deviation's rotation and tilt follow the nominal ones:
/// R = R_tilt R_z R_nominal. Without a deviation it is the nominal camera, bit for bit.
CameraGeometry actual_camera(const CameraGeometry& nominal, const CameraDeviation& deviation);

}  // namespace fidservo::plant
