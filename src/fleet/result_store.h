// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The results of a fleet: a folder in which each result appears only once and only when it is complete, even
// if several processes write there at a time.
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::fleet {

/// The format of a result, which begins with the keys "format", "task", "rig", "program", "effort", "key",
/// "status".
inline constexpr const char* result_format = "fidservo-fleet-result/1";

/// The identity of a result.
struct ResultName {
    std::string stem;  ///< file_stem() of the task's subject
    std::string key;   ///< SHA-256 of everything from which the result is made

    /// Its file's name, STEM-KEY.json, with the key's first 16 digits.
    std::string file() const;
};

/// The stem of such a file's name; empty: it is no result.
std::string stem_of_result(const std::string& file);

/// FLEET/results. Several processes, also on several machines that share the folder, may use it at a time: a
/// result is written to a file of a unique name, flushed to the disk, and then hard-linked to its final name,
/// which only the first writer can create.
class ResultStore {
  public:
    /// Makes the folder if it is not there, and looks at what is in it. Throws InputError if it cannot be
    /// made.
    explicit ResultStore(const std::filesystem::path& fleet);

    const std::filesystem::path& folder() const { return folder_; }

    /// The text of a result; empty if there is none. A result in FLEET/superseded is moved back.
    std::optional<std::string> find(const ResultName& name) const;

    /// Writes a result, unless it exists with the same bytes. Results of the same task from other inputs are
    /// moved to FLEET/superseded, so that FLEET/results has one result for each task. Throws RunFault if it
    /// cannot be written, or if it exists with other bytes.
    void publish(const ResultName& name, std::string_view text) const;

    /// Removes unfinished files that were left by killed processes: those of this run, and those of other
    /// runs whose result exists. Files that another process may still be writing stay.
    void sweep() const;

  private:
    std::filesystem::path draft_of(const ResultName& name) const;
    void supersede_others(const ResultName& name) const;

    std::filesystem::path folder_, superseded_;
    std::string token_;                                      ///< identifies this run's drafts
    std::map<std::string, std::vector<std::string>> files_;  ///< by stem, as they were at the start
};

}  // namespace fidservo::fleet
