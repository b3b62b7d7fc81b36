// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The camera that the option --camera selects.
#include "core/camera/camera_parameters.h"
#include "src/session/session.h"
#include "vision/camera.h"

#include <memory>

namespace fidservo {

/// Whether --camera is "sim".
bool camera_is_simulated(const SessionOptions& options);

/// Opens and starts the camera of "v4l2:NODE", set as the rig file says. Throws InputError for another
/// word, a device that is not there or settings that it cannot have; RunFault where the device fails.
std::shared_ptr<vision::Camera> open_camera(const SessionOptions& options, const CameraParameters& camera);

/// The counts in words: "200 frames used, 3 skipped for newer ones, 2 lost by the camera".
std::string text_of(const vision::FrameCounts& counts);

}  // namespace fidservo
