// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fingerprints of everything on which a run's results depend.
#include "src/inspect/journal.h"
#include "src/inspect/recipe/recipe.h"
#include "src/session/session.h"

namespace fidservo::inspect {

/// SHA-256 of the recipe file, of the rig file, of the nominal plate as a list of all it holds, of the
/// simulated printed plate's and the simulated rig's files, and of the numbers by which images and sensor
/// readings become lengths. Reference images count with the recipe. Throws InputError if a file cannot be
/// read.
RunIdentity identity_of(const Recipe& recipe, const Rig& rig, const SessionOptions& session);

/// The numbers of the camera and of the Hall sensor as text.
std::string calibration_text(const Rig& rig);
/// Everything on a plate as text.
std::string plate_text(const Plate& plate);

}  // namespace fidservo::inspect
