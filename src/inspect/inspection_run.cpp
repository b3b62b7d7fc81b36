// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/inspection_run.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/disk/output_paths.h"
#include "src/files/recording/utc_time.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/inspect/identity.h"
#include "src/inspect/journal.h"
#include "src/inspect/live_progress.h"
#include "src/inspect/measure/nominal_drawing.h"
#include "src/inspect/measure/reference_check.h"
#include "src/inspect/measure/site_visit.h"
#include "src/inspect/report/inspection_report.h"
#include "src/inspect/report/rig_history.h"
#include "src/inspect/run_json.h"
#include "src/inspect/saved_images.h"
#include "src/live/live_server.h"
#include "src/process/exit_code.h"
#include "src/session/camera_choice.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

void home(Session& session, const OutputFolder& output) {
    const std::filesystem::path recording = output.root / "recordings/homing";
    set_aside(recording);
    session.record_to(recording, "homing");
    const auto homed = session.home();
    if (!homed) {
        session.leave_recording();
        throw RunFault(fmt::format("homing: {}: {}", name_of(homed.error().reason), homed.error().text));
    }
    if (const auto closed = session.end_recording(); !closed) throw RunFault(closed.error().text);
}

std::string one_line(const Visit& visit) {
    std::string text =
        fmt::format("site {:>3}  {:<9}", visit.site,
                    visit.end == Visit::End::measured ? name_of(outcome_of(visit)) : name_of(visit.end));
    if (visit.end == Visit::End::measured) {
        const auto bad = std::ranges::count_if(
            visit.rows, [](const ResultRow& row) { return row.verdict != Outcome::pass; });
        text += bad == 0 ? fmt::format("  {} checks", visit.rows.size())
                         : fmt::format("  {} of {} checks", bad, visit.rows.size());
    } else {
        text += "  " + visit.failures.back().reason + ": " + visit.failures.back().text;
    }
    return text;
}

/// Sites that are visited a second time.
std::size_t deferred(const std::vector<Visit>& visits) {
    return static_cast<std::size_t>(std::ranges::count(visits, Visit::End::deferred, &Visit::end));
}

/// A line for the last visit.
void say(const std::vector<Visit>& visits, const Recipe& recipe) {
    fmt::print("{:>3} of {}  {}\n", visits.size(), recipe.sites.size() + deferred(visits),
               one_line(visits.back()));
    std::fflush(stdout);
}

/// A reference image that cannot serve ends the run before it begins.
void demand_reference_images(const Recipe& recipe, const CameraParameters& camera) {
    for (const Site& site : recipe.sites)
        for (const View& view : site.views)
            for (const Check& check : view.checks)
                if (const auto* reference = std::get_if<ReferenceCheck>(&check);
                    reference && reference->image)
                    (void)load_reference(*reference->image, camera, recipe.nominal, site.tag_id);
}

/// A run under way.
struct Run {
    const Recipe& recipe;
    const Rig& rig;
    const OutputFolder& output;
    Session& session;
    Journal& journal;
    JournalContent& content;
    LiveProgress& progress;
    bool simulated;
};

void pause_if_asked(Session& session, LiveProgress& progress) {
    if (!progress.pause_is_asked()) return;
    progress.is_at("paused");
    const auto waited = session.wait_while([&] { return progress.pause_is_asked(); });
    if (!waited) throw RunFault(fmt::format("paused: {}; --resume goes on from here", waited.error().text));
}

/// Homes the rig, or takes up where the journal ends.
void begin(const Run& run) {
    const JournalContent& content = run.content;
    const bool all_done = content.checkpoint && !next_visit(run.recipe.sites, content.visits);
    if (content.checkpoint && (run.simulated || all_done)) {
        if (run.simulated) run.session.restore(*content.checkpoint);
    } else {
        fmt::print("homing\n");
        run.progress.is_at("homing");
        home(run.session, run.output);
        run.journal.homed(run.session.checkpoint());
    }
    run.progress.has_visited(content.visits);
}

void visit_all(const Run& run) {
    std::vector<Visit>& visits = run.content.visits;
    const DrawNominal draw_nominal = nominal_drawing(*run.rig.camera, run.recipe.nominal);
    vision::TagDetector detector(vision::machine_camera_options({run.recipe.nominal.print()}));
    const VisitContext context{{run.recipe, *run.rig.camera, run.output, draw_nominal, detector},
                               run.session};
    while (const auto next = next_visit(run.recipe.sites, visits)) {
        pause_if_asked(run.session, run.progress);
        run.progress.goes_to(*next);
        const Visit visit = visit_site(context, *next);
        run.journal.ended(visit, run.session.checkpoint());
        visits.push_back(visit);
        run.progress.has_visited(visits);
        say(visits, run.recipe);
    }
}

DeviceFigures figures_of(const Session& session) {
    const vision::FrameCounts frames = session.frame_counts();
    return {session.loop_statistics(),
            frames == vision::FrameCounts{} ? std::nullopt : std::optional(frames)};
}

/// What scripts and people read, once all sites are done.
/// @return the report as it was written
InspectionReport write_all(const OutputFolder& output, const Recipe& recipe, const Rig& rig,
                           const JournalContent& content, const DeviceFigures& devices) {
    write_results(output.results(), content.visits);
    write_run_json(output.run_json(), recipe, content, devices);
    InspectionReport all = inspection_report(output, recipe, rig, content, devices);
    write_inspection_report(output, all);
    return all;
}

void refuse_what_moves(const InspectionOptions& options) {
    const auto refuse = [&](std::string_view what) {
        throw InputError(fmt::format("--camera {}: nothing moves; {}", options.session.camera, what));
    };
    if (options.session.stage != "sim") refuse("leave --stage out");
    if (options.resume) refuse("leave --resume out and begin again");
    if (options.live_port) refuse("leave --live out");
    if (!options.session.faults.empty()) refuse("leave --fault out");
}

Counts measure_again(const InspectionOptions& options, const std::filesystem::path& folder,
                     const Recipe& recipe, const Rig& rig, const RunIdentity& identity) {
    refuse_what_moves(options);
    const SavedImages images(folder, recipe);
    const OutputFolder output{options.out};
    make_output_folder(output.root);
    std::filesystem::create_directories(output.root / "images");
    const DrawNominal draw_nominal = nominal_drawing(*rig.camera, recipe.nominal);
    vision::TagDetector detector(vision::machine_camera_options({recipe.nominal.print()}));
    const Measuring measuring{recipe, *rig.camera, output, draw_nominal, detector};
    JournalContent content{identity, {}, {}, 0};
    for (const Site& site : recipe.sites) {
        content.visits.push_back(measure_saved(measuring, images, site));
        say(content.visits, recipe);
    }
    (void)write_all(output, recipe, rig, content, {});
    return count(content.visits);
}

/// What a run is about.
struct Task {
    const Rig& rig;
    const Recipe& recipe;
    const Plate& printed;
    const RunIdentity& identity;
};

/// What a run has come to.
struct Ran {
    Counts counts;
    InspectionReport report;
};

/// The rig is switched off when it returns.
Ran run_on_rig(const InspectionOptions& options, const SessionOptions& session_options, const Task& task,
               const OutputFolder& output) {
    const auto& [rig, recipe, printed, identity] = task;
    JournalContent content{identity, {}, {}, 0};
    std::optional<Journal> journal;
    const bool begins = !options.resume || killed_before_it_began(output.journal());
    if (!begins) {
        auto [taken_up, so_far] = Journal::resume(output.journal(), identity);
        journal.emplace(std::move(taken_up));
        content = std::move(so_far);
    }
    Session session(session_options, rig, recipe.nominal, printed);
    if (!options.resume) make_output_folder(output.root);
    if (begins) {
        std::filesystem::remove(output.journal());  // a first line cut short
        journal.emplace(output.journal(), identity);
    }
    std::filesystem::create_directories(output.root / "images");
    std::filesystem::create_directories(output.root / "recordings");

    LiveProgress progress(options.live_port ? std::make_shared<LiveFeed>() : nullptr, recipe);
    std::optional<LiveServer> page;
    if (options.live_port) {
        session.show_to(progress.feed());
        page.emplace(*options.live_port, progress.feed(), rig, [&session] { session.stop_now(); });
        fmt::print("live: {}\n", page->url());
        std::fflush(stdout);
    }
    const bool simulated = session_options.stage == "sim" && camera_is_simulated(session_options);
    const Run run{recipe, rig, output, session, *journal, content, progress, simulated};
    try {
        begin(run);
        visit_all(run);
    } catch (const RunFault& fault) {
        progress.is_at("stopped", fault.what());
        throw;
    }
    InspectionReport all = write_all(output, recipe, rig, content, figures_of(session));
    progress.is_at("done");
    return {count(content.visits), std::move(all)};
}

}  // namespace

Counts run_inspection(const InspectionOptions& options) {
    const Rig rig = load_rig(options.session.rig_file);
    const Recipe recipe = load_recipe(options.recipe, rig);
    demand_reference_images(recipe, rig.camera.value());
    const Plate printed = recipe.simulation.plate ? load_plate(*recipe.simulation.plate) : recipe.nominal;
    SessionOptions session_options = options.session;
    session_options.camera_reconnect_s = recipe.camera_reconnect_s;
    session_options.seed = options.seed.value_or(recipe.simulation.seed);
    const RunIdentity identity = identity_of(recipe, rig, session_options);
    if (const auto folder = images_folder(session_options.camera))
        return measure_again(options, *folder, recipe, rig, identity);

    const OutputFolder output{options.out};
    Ran ran = run_on_rig(options, session_options, {rig, recipe, printed, identity}, output);
    if (options.diagnosis) {
        fmt::print("diagnosing what was recorded\n");
        std::fflush(stdout);
        RigFindings findings = find_in_recordings(output, rig, options.session.rig_file);
        fmt::print("{}\n", findings.line);
        if (!options.history.empty()) {
            RecordingOrigin origin = session_options.origin;
            origin.recorded_at = utc_now();
            const HistoryFindings history =
                append_to_history(options.history, rig, identity.rig_sha256, findings, origin);
            for (const std::string& line : history.lines) fmt::print("{}\n", line);
            findings.html += history.html;
        }
        write_inspection_report(output, with_findings(std::move(ran.report), findings));
    }
    return ran.counts;
}

}  // namespace fidservo::inspect
