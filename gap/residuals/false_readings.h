// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which sensor's false readings displace the tags.
//
// Tags are predicted from what encoder and Hall sensor have read. If a sensor's predicted reading differs
// from its actual one by e, mm, then either the model of what drives the stage is wrong, which does not
// affect the prediction of the tags, or the reading is wrong, which shifts the tags along the stage's motion
// by -e. Only deviations from a window's mean shift count, since the position at the start of a window is
// estimated from tags.
#include "gap/evidence.h"

#include <optional>

namespace fidservo::gap {

/// The sensor, encoder or hall, whose reading is false: by the windows' losses (gap/fit/score.h), the tags
/// are twenty times as likely with a shift by -e as without. If this holds for both sensors, the likelier
/// one. Empty without tags.
/// @param errors  of all windows
std::optional<Signal> sensor_that_displaces_tags(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
