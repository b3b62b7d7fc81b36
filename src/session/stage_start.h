// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a real stage has to show before anything is entrusted to it.
#include "control/loop_statistics.h"
#include "src/session/pilot.h"

#include <string>

namespace fidservo {

/// Pushes the carriage by some mm and back, and warms the wire until the platform moves: do encoder and Hall
/// sensor answer (control/stage_check.h)? Throws RunFault with what they did not do.
void check_stage(Pilot& pilot);

/// "61234 ticks, late by 5 us (median), 23 us (99 %), 140 us at most; 0 overruns, 1204 held"; then what the
/// system did not permit.
std::string text_of(const control::LoopStatistics& loop);

}  // namespace fidservo
