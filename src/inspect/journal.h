// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The memory of a run that may be killed at any moment: one JSON line for what began, one for each visit that
// ended, each on the disk before the run goes on. A line that was cut short does not count.
#include "src/inspect/measure/results.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::inspect {

/// What a run is bound to. A run can be resumed only with the same.
struct RunIdentity {
    std::string recipe_sha256;
    std::string rig_sha256;
    std::string plate_sha256;        ///< the nominal plate
    std::string printed_sha256;      ///< the simulated printed plate; empty without a simulation
    std::string calibration_sha256;  ///< what the program knows of camera and sensors
    std::uint64_t seed;
    std::string stage, camera;
    std::string version;

    bool operator==(const RunIdentity&) const = default;
};

/// What a journal says.
struct JournalContent {
    RunIdentity identity;
    std::vector<Visit> visits;
    std::optional<std::string> checkpoint;  ///< after homing or the last visit; empty: not even homed
    int resumed = 0;                        ///< how often the run was taken up again
};

/// Whether a run's folder was made but the run killed before its journal's first line was on the disk: there
/// is nothing to go on from, and the run begins in that folder. Any other content makes the answer no.
bool killed_before_it_began(const std::filesystem::path& journal_file);

class Journal {
  public:
    /// Begins a new journal. Throws RunFault if the disk does not take it.
    Journal(const std::filesystem::path& file, const RunIdentity& identity);
    /// Goes on with an old one. Cuts off an unfinished last line. Throws InputError if there is no journal,
    /// if it cannot be read, or if it is of another recipe, rig, plate, seed or device.
    static std::pair<Journal, JournalContent> resume(const std::filesystem::path& file,
                                                     const RunIdentity& identity);

    void homed(const std::string& checkpoint);
    void ended(const Visit& visit, const std::string& checkpoint);

  private:
    explicit Journal(std::filesystem::path file) : file_(std::move(file)) {}
    std::filesystem::path file_;
};

}  // namespace fidservo::inspect
