// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Renders the nominal plate as an ideal camera would see it.
#include "core/camera/camera_parameters.h"
#include "src/inspect/measure/checks.h"

namespace fidservo::inspect {

/// Draws under even light and without noise, with the camera's own blur, seen from a plate point.
DrawNominal nominal_drawing(const CameraParameters& camera, const Plate& nominal);

}  // namespace fidservo::inspect
