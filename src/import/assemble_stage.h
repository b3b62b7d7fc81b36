// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The stage's rows of a recording, from the signals that a map names.
#include "src/import/assemble.h"
#include "src/import/signal_times.h"

namespace fidservo::imports {

/// If all columns have the same times, a tick apart, the rows are those of the log; otherwise all columns are
/// resampled to rows a tick apart (docs/import.md). The tick is estimated if the map does not state it. NaN
/// samples of a reading count as missing. Throws InputError.
void add_stage(SignalSource& source, const ImportMap& map, Assembled& made);

}  // namespace fidservo::imports
