// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What `record` is to do: which experiments, in which folders, and how long that takes.
#include "src/session/session.h"
#include "src/simulation/experiments.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

struct ExperimentOptions {
    SessionOptions session;  ///< its seed also determines the excitation
    std::string experiment;  ///< a kind, campaign, or a file that describes one
    std::filesystem::path out;
    bool frames = false;
    bool resume = false;
};

/// Whether two of each experiment are asked for.
bool is_campaign(const ExperimentOptions& options);

/// A recording to be made.
struct PlannedRun {
    std::string name;
    std::filesystem::path folder;
    Experiment experiment;
};

struct RecordPlan {
    std::vector<PlannedRun> runs;
    std::vector<std::string> left_out;  ///< of a campaign: "NAME: why the rig cannot do it"
};

/// The recordings that are asked for, whether they are there or not: for the same seed and rig the names and
/// the excitations of `simulate`. Throws InputError where the rig cannot do the experiment, or none of the
/// campaign.
RecordPlan plan_recordings(const ExperimentOptions& options, const Rig& rig, const Plate& plate);

/// Those of a plan that are not there whole. Throws InputError if a recording is of another experiment.
std::vector<PlannedRun> missing_runs(const RecordPlan& plan);

/// Whether an experiment may heat the wire.
bool heats(const Experiment& experiment);

/// Homing, ways, cooling and the recordings themselves, s of the rig's time.
double expected_s(const std::vector<PlannedRun>& runs, const Rig& rig);

}  // namespace fidservo
