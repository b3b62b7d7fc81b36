// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The record of a run that may be killed at any moment: one JSON line for its beginning and one for each
// completed visit, each on the disk before the run goes on. A truncated line is ignored.
#include "src/inspect/measure/results.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::inspect {

/// Fingerprints of a run. It can only be resumed with the same ones.
struct RunIdentity {
    std::string recipe_sha256;
    std::string rig_sha256;
    std::string plate_sha256;        ///< the nominal plate
    std::string printed_sha256;      ///< the simulated printed plate; empty without a simulation
    std::string calibration_sha256;  ///< the program's numbers for camera and sensors
    std::uint64_t seed;
    std::string stage, camera;
    std::string version;

    bool operator==(const RunIdentity&) const = default;
};

/// The content of a journal.
struct JournalContent {
    RunIdentity identity;
    std::vector<Visit> visits;
    std::optional<std::string> checkpoint;  ///< state after homing or the last visit; empty: not homed yet
    int resumed = 0;                        ///< number of times that the run was resumed
};

/// Whether a run's folder was made but the run killed before its journal's first line was on the disk: the
/// run then begins anew in that folder. False for any other content.
bool killed_before_it_began(const std::filesystem::path& journal_file);

class Journal {
  public:
    /// Begins a new journal. Throws RunFault if the disk does not take it.
    Journal(const std::filesystem::path& file, const RunIdentity& identity);
    /// Opens the journal of a run to be resumed. Cuts off an incomplete last line. Throws InputError if there
    /// is no journal, if it cannot be read, or if it is of another recipe, rig, plate, seed or device.
    static std::pair<Journal, JournalContent> resume(const std::filesystem::path& file,
                                                     const RunIdentity& identity);

    void homed(const std::string& checkpoint);
    void ended(const Visit& visit, const std::string& checkpoint);

  private:
    explicit Journal(std::filesystem::path file) : file_(std::move(file)) {}
    std::filesystem::path file_;
};

}  // namespace fidservo::inspect
