// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The check of a real stage before it is used.
#include "control/loop_statistics.h"
#include "src/session/pilot.h"

#include <string>

namespace fidservo {

/// Pushes the carriage by some mm and back, and warms the wire until the platform moves: checks that encoder
/// and Hall sensor respond (control/stage_check.h). Throws RunFault that tells what did not respond.
void check_stage(Pilot& pilot);

/// "61234 ticks, late by 5 us (median), 23 us (99 %), 140 us at most; 0 overruns, 1204 held"; then what the
/// system did not permit.
std::string text_of(const control::LoopStatistics& loop);

}  // namespace fidservo
