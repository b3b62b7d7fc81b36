// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The stage's rows of a recording, from the signals that a map names.
#include "src/import/assemble.h"
#include "src/import/signal_times.h"

namespace fidservo::imports {

/// Where all columns have the same times, a tick apart, rows are those of the log; otherwise all are
/// resampled to rows a tick apart (docs/import.md). Finds the tick where the map does not state it. Samples
/// of a reading without a number count as missing. Throws InputError.
void add_stage(SignalSource& source, const ImportMap& map, Assembled& made);

}  // namespace fidservo::imports
