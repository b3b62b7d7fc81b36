// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/failure.h"
#include "core/result.h"
#include "src/session/pilot.h"

namespace fidservo {

/// Whether a failed motion with this reason may be due to a defect of the rig, which then has to be checked.
constexpr bool puts_rig_in_doubt(Reason reason) {
    return reason == Reason::timeout || reason == Reason::no_convergence || reason == Reason::not_at_rest ||
           reason == Reason::out_of_reach;
}

/// Does the rig still answer? Asked after a motion that did not end as it should, and before a site is given
/// up for it. A frame comes that can be an image of the plate; the
/// carriage goes two millimetres, and the encoder follows; the platform goes
/// 0.6 mm, and the Hall sensor follows; where it does not, the camera tells whether the sensor or the
/// actuator is at fault. Then the camera is registered anew by what it sees. Fails with Reason::device, in
/// words for the user, or Reason::stopped.
Status check_rig(Pilot& pilot);

/// Whether a frame comes that can be an image of the plate; a camera that may come back is waited for. Fails
/// with Reason::device, in words for the user, or Reason::stopped.
Status check_camera(Pilot& pilot);

/// Whether the carriage answers: told to go two millimetres towards the middle of its travel, it does by the
/// encoder, and comes to rest. Fails with Reason::device, in words for the user, or Reason::stopped.
Status check_carriage(Pilot& pilot);

/// The failure for a Hall sensor that shows no motion, depending on whether the camera saw one.
Failure unmoved_platform(double hall_mm, double camera_mm);

}  // namespace fidservo
