// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/result.h"
#include "src/session/pilot.h"

#include <vector>

namespace fidservo {

/// The tags of a plate that can serve to register the carriage's position.
std::vector<PlateTag> registration_tags(const Rig& rig, const Plate& plate);

/// Homes the rig: slowly to the end stop, registration against a tag, whose id and place fix the absolute
/// position, and the tuning sweep of the micro stage (tuning_sweep.h). Ends with the platform in the middle
/// of its travel.
Status home(Pilot& pilot);

}  // namespace fidservo
