#pragma once
#include "src/session/pilot.h"

namespace fidservo {

/// Does the rig still answer? Asked after a motion that did not end as it should, and before a site is given
/// up for it. A frame comes that can be an image of the plate; the
/// carriage goes two millimetres, and the encoder follows; the platform goes
/// 0.6 mm, and the Hall sensor follows; where it does not, the camera tells whether the sensor or the
/// actuator is at fault. Then the camera is registered anew by what it sees. Fails with Reason::device, in
/// words for the user, or Reason::stopped.
Status check_rig(Pilot& pilot);

/// Why the Hall sensor shows no motion, by whether the camera saw one.
Failure unmoved_platform(double hall_mm, double camera_mm);

}  // namespace fidservo
