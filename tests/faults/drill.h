// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A small inspection on the simulated rig with deliberate faults, and its result.
#include "src/inspect/inspection_run.h"
#include "src/session/faults.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::testing {

/// The measured rows of results.csv, by "site,view,check,feature".
struct MeasuredRow {
    std::optional<double> value, uncertainty;
    std::string verdict;
};

struct DrillEnd {
    bool stopped = false;       ///< by a RunFault
    std::string text;           ///< the fault's message, the log and the journal
    bool outputs_zero = false;  ///< the board's outputs are zero after the end
};

/// Three sites; faults act during the visit to the second one.
class Drill {
  public:
    /// Runs once without faults, in a new folder.
    explicit Drill(const std::filesystem::path& folder);

    /// Session time at which the second site's visit begins, s.
    double second_visit_s() const { return second_visit_s_; }
    const std::filesystem::path& whole() const { return whole_; }

    /// Continues from the homed rig with faults.
    /// @param name  of the run's folder
    DrillEnd run(const std::string& name, const std::vector<Fault>& faults) const;
    /// A run from the start with faults.
    DrillEnd run_from_start(const std::string& name, const std::vector<Fault>& faults) const;
    /// Resumes that run without the faults.
    DrillEnd resume(const std::string& name) const;

    /// A run from the start whose recipe lets a lost camera be waited for.
    DrillEnd run_waiting_for_the_camera(const std::string& name, const std::vector<Fault>& faults) const;

    /// A run from the start on a plate on which tags 52 and 80 are exchanged.
    DrillEnd run_with_wrong_tag(const std::string& name) const;

    std::filesystem::path out(const std::string& name) const { return folder_ / name; }

  private:
    /// Writes the drill's recipe with additional keys.
    /// @return its path
    std::filesystem::path recipe_with(const std::string& name, const std::string& keys) const;
    inspect::InspectionOptions options(const std::filesystem::path& out) const;
    DrillEnd go_on(const std::string& name, const std::vector<Fault>& faults) const;
    DrillEnd end_of(const inspect::InspectionOptions& options) const;

    std::filesystem::path folder_, whole_;
    double second_visit_s_ = 0.0;
};

std::map<std::string, MeasuredRow> measured_rows(const std::filesystem::path& results_csv);
std::string text_of_file(const std::filesystem::path& file);

}  // namespace fidservo::testing
