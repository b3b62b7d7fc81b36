// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/record_experiments.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/disk/output_paths.h"
#include "src/files/recording/writer.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/process/exit_code.h"
#include "src/process/progress.h"
#include "src/record/campaign_file.h"
#include "src/record/on_rig.h"
#include "src/record/start.h"
#include "src/session/pilot.h"
#include "src/simulation/experiment_law.h"

#include <cstdio>

#include <fmt/format.h>

namespace fidservo {

namespace {

void say(const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
}

/// Ends the run where something went wrong; what was recorded so far stays, unfinished.
[[noreturn]] void stop_run(Session& session, std::string_view what, const Failure& why) {
    session.leave_recording();
    throw RunFault(
        fmt::format("{}: {}: {}; --resume goes on from here", what, name_of(why.reason), why.text));
}

void say_plan(const RecordPlan& plan, const std::vector<PlannedRun>& runs, const Rig& rig) {
    for (const std::string& left_out : plan.left_out) say("left out: " + left_out);
    if (runs.size() < plan.runs.size())
        say(fmt::format("{} of {} recordings are there", plan.runs.size() - runs.size(), plan.runs.size()));
    double recorded_s = 0.0;
    for (const PlannedRun& run : runs) recorded_s += run.experiment.duration_s;
    say(fmt::format(
        "{} recording{}, {:.0f} s; with homing, ways and cooling about {:.0f} s of the rig's time",
        runs.size(), runs.size() == 1 ? "" : "s", recorded_s, expected_s(runs, rig)));
}

/// The recordings that are still to be made; the folder for them is there.
std::vector<PlannedRun> open_output(const ExperimentOptions& options, const RecordPlan& plan) {
    if (options.resume) {
        if (is_campaign(options)) demand_same_campaign(options);
        return missing_runs(plan);
    }
    if (is_campaign(options)) {
        make_output_folder(options.out);
        begin_campaign(options);
    } else if (std::filesystem::exists(options.out)) {
        throw InputError(
            fmt::format("--out {}: exists already; --resume goes on with it", options.out.string()));
    } else {
        demand_new_folder(options.out);
    }
    return plan.runs;
}

RecordingOptions recording_of(const PlannedRun& run, bool frames) {
    RecordingOptions recording;
    recording.name = run.name;
    recording.experiment = run.experiment.kind;
    recording.controllers = controllers_of(run.experiment);
    recording.frames = frames;
    recording.origin.request_sha256 = run.request_sha256;
    return recording;
}

/// @return whether the experiment went to its end
bool record_one(Session& session, ExperimentStart& start, const PlannedRun& run, bool frames) {
    const auto remark = start.bring_to(run.experiment.carriage_mm);
    if (!remark) stop_run(session, run.name + ": on the way to its start", remark.error());
    set_aside(run.folder);
    session.record_to(run.folder, recording_of(run, frames));
    if (!remark->empty()) session.pilot().machine.note("start", *remark);
    Progress progress("s of " + run.name, static_cast<std::size_t>(run.experiment.duration_s));
    const auto end = run_on_rig(session, run.experiment, progress);
    progress.finish();
    if (heats(run.experiment)) start.heater_was_on();
    if (!end) stop_run(session, run.name, end.error());
    if (*end == ExperimentEnd::end_of_travel) {
        session.leave_recording();
        say(run.name + ": broken off at an end of travel; kept as it is, unfinished");
        return false;
    }
    if (const auto closed = session.end_recording(); !closed) stop_run(session, run.name, closed.error());
    return true;
}

}  // namespace

bool record_experiments(const ExperimentOptions& options) {
    const Rig rig = load_rig(options.session.rig_file);
    const Plate plate = rig_plate(rig, options.session.rig_file);
    const RecordPlan plan = plan_recordings(options, rig, plate);
    const std::vector<PlannedRun> runs = open_output(options, plan);
    if (runs.empty()) {
        say(fmt::format("nothing to do: all is in {}", options.out.string()));
        return true;
    }
    say_plan(plan, runs, rig);
    Session session(options.session, rig, plate, plate);
    if (const auto homed = session.home(); !homed) stop_run(session, "homing", homed.error());
    ExperimentStart start(session.pilot());
    std::size_t whole = 0;
    for (const PlannedRun& run : runs) {
        if (!record_one(session, start, run, options.frames)) continue;
        ++whole;
        say(fmt::format("{}: recorded, {} of {}", run.name, whole, runs.size()));
    }
    say(fmt::format("{} of {} recordings in {}, {:.0f} s of the rig's time", whole, runs.size(),
                    options.out.string(), session.elapsed_s()));
    return whole == runs.size();
}

}  // namespace fidservo
