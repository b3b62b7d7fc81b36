// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A whole inspection, from the recipe to the report; or what is left of one that was killed.
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
    bool diagnosis =
        false;  ///< of the rig, by what the run has recorded; after it, with the stage switched off
    std::filesystem::path history;  ///< of the rig, to which the diagnosis is appended; empty: none
    std::optional<int> live_port;   ///< of the live page (src/live/live_server.h); 0: any; empty: no page
};

/// Runs it, and leaves results.csv, run.json, report.html, images and recordings in the output folder, with a
/// diagnosis also diagnosis.html and diagnosis.json.
/// Everything measured at a site is on the disk before the next one begins. On the images of an earlier run
/// (saved_images.h) nothing moves, and there are no recordings. Throws InputError before anything
/// is moved or written, RunFault if the run cannot go on.
/// @return the number of rows by outcome
Counts run_inspection(const InspectionOptions& options);

}  // namespace fidservo::inspect
