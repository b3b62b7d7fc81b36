// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which sensor's false readings displace the tags.
//
// Tags are predicted from what encoder and Hall sensor have read. Where a sensor's prediction differs from
// its reading by e, mm, either the model of what drives the stage is wrong, which displaces no tag, or the
// reading is, which displaces the tags along the stage's motion by -e. Within a window the displacement
// counts from its mean, since where the window begins was estimated from tags.
#include "gap/evidence.h"

#include <optional>

namespace fidservo::gap {

/// The sensor, encoder or hall, whose reading is false: by the windows' losses (gap/fit/score.h) it is twenty
/// times as likely that the tags are displaced by -e as that they are not. If that is so of both, the
/// likelier one. Empty without tags.
/// @param errors  of all windows
std::optional<Signal> sensor_that_displaces_tags(const Evidence& evidence, const Errors& errors);

}  // namespace fidservo::gap
