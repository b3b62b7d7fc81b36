// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A whole inspection from the recipe to the report, or the rest of one that was killed.
#include "src/inspect/measure/results.h"
#include "src/session/session.h"

#include <filesystem>
#include <optional>

namespace fidservo::inspect {

struct InspectionOptions {
    std::filesystem::path recipe;
    SessionOptions session;  ///< its seed is the recipe's unless `seed` is given
    std::optional<std::uint64_t> seed;
    std::filesystem::path out;
    bool resume = false;
    /// Diagnose the rig from the run's recordings, after the run, with the stage switched off.
    bool diagnosis = false;
    /// The rig's history file, to which the diagnosis is appended; empty: none.
    std::filesystem::path history;
    std::optional<int> live_port;  ///< of the live page (src/live/live_server.h); 0: any; empty: no page
};

/// Runs it, and leaves results.csv, run.json, report.html, images and recordings in the output folder, with a
/// diagnosis also diagnosis.html and diagnosis.json.
/// Everything measured at a site is on the disk before the next one begins. On the images of an earlier run
/// (saved_images.h) nothing moves, and there are no recordings. Throws InputError before anything
/// is moved or written, RunFault if the run cannot go on.
/// @return the number of rows by outcome
Counts run_inspection(const InspectionOptions& options);

}  // namespace fidservo::inspect
