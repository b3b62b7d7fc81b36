// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The recordings from which a case with frames is diagnosed.
#include "core/recording.h"
#include "src/selfcheck/draw/true_rig.h"

#include <cstdint>
#include <vector>

namespace fidservo::selfcheck {

/// Eight recordings on the independent model of the true rig, each filmed for 2 s (reference/tag_picture.h).
/// The program's detector finds the tags in the frames, and their appearance is measured as `diagnose` does;
/// the frames are not kept. Computed on all cores. Throws InputError if the rig's camera does not look
/// straight down.
std::vector<Recording> film_campaign(const Rig& nominal, const TrueRig& true_rig, std::uint64_t seed);

}  // namespace fidservo::selfcheck
