// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The plan of `record`: which experiments go to which folders, and how long that takes.
#include "src/session/session.h"
#include "src/simulation/experiments.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

struct ExperimentOptions {
    SessionOptions session;  ///< its seed also determines the excitation
    std::string experiment;  ///< a kind of experiment, "campaign", or an experiment file
    std::filesystem::path out;
    bool frames = false;
    bool resume = false;
};

/// Whether the campaign is asked for: two of each experiment.
bool is_campaign(const ExperimentOptions& options);

/// A recording to be made.
struct PlannedRun {
    std::string name;
    std::filesystem::path folder;
    Experiment experiment;
    std::string request_sha256;  ///< of the rig's files, the seed and all commands
};

struct RecordPlan {
    std::vector<PlannedRun> runs;
    std::vector<std::string> left_out;  ///< of a campaign: "NAME: why the rig cannot do it"
};

/// The recordings that are asked for, whether they are there or not: for the same seed and rig the names and
/// the excitations of `simulate`, but for those that the rig cannot do and of which another draw it can
/// (draw_for). Throws InputError where the rig cannot do the experiment, or none of the
/// campaign.
RecordPlan plan_recordings(const ExperimentOptions& options, const Rig& rig, const Plate& plate);

/// The recordings of a plan that do not exist or are unfinished. Throws InputError if an existing recording
/// is of another experiment, or was asked for with another rig file, other commands or another seed.
std::vector<PlannedRun> missing_runs(const RecordPlan& plan);

/// Whether an experiment may heat the wire.
bool heats(const Experiment& experiment);

/// Time on the rig, s, for homing, moves, cooling and the recordings themselves.
double expected_s(const std::vector<PlannedRun>& runs, const Rig& rig);

}  // namespace fidservo
