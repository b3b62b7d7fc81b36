// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Input of identifications: recordings of a rig, or a text table.
#include "core/recording.h"
#include "core/rig.h"
#include "src/identify/text_table.h"

#include <optional>
#include <vector>

namespace fidservo {

struct IdentifyInput {
    Rig rig;                            ///< the rig file's present numbers
    std::vector<Recording> recordings;  ///< empty if a table is given
    std::optional<TextTable> table;
    double table_rate_hz = 0.0;  ///< rows per second; 0: the table has a column with the role time
};

/// Times in s of a table's rows. Throws InputError where time does not increase, and where its unit is not
/// stated and seconds are not plausible.
std::vector<double> table_times_s(const IdentifyInput& input);

/// Throws InputError if rows are missing: a model that is run through a recording needs every tick.
void demand_every_tick(const Recording& recording);

/// Throws InputError on a Hall reading that the rig's converter cannot give.
void demand_possible_readings(const Recording& recording, const HallParameters& hall);

/// A table as a recording of the macro stage: roles input [V] and output [mm]. A row a tick; throws
/// InputError unless the times are equally spaced to 1 %.
Recording table_as_macro_recording(const IdentifyInput& input);

}  // namespace fidservo
