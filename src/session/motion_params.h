// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "control/homing.h"
#include "control/positioner.h"

namespace fidservo {

struct Rig;

/// The positioner of a rig as its file describes it. Throws InputError if the rig lacks what positioning
/// needs: micro stage, camera, and the gains of both controllers.
control::PositionerParams positioner_params(const Rig& rig, double tolerance_mm);

/// Camera positions, plate x, mm, at which motions may end: the macro stage's travel, and the platform's
/// except its ends.
struct CameraTravel {
    double low_mm, high_mm;
};
CameraTravel camera_travel(const Rig& rig);

control::HomingParams homing_params(const Rig& rig);

}  // namespace fidservo
