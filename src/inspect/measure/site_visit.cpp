// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/site_visit.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/units.h"
#include "src/files/disk/output_paths.h"
#include "src/session/rig_check.h"

#include <utility>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

[[noreturn]] void stop_run(const Site& site, const Failure& why) {
    throw RunFault(fmt::format("site {}: {}: {}; --resume goes on from here", site.tag_id,
                               name_of(why.reason), why.text));
}

Result<Snapshot> take_snapshot(const VisitContext& context, const Site& site, const View& view,
                               Visit& visit) {
    const auto arrival = context.session.go_to(site.tag_id, mm_from_um(view.offset_um));
    if (!arrival) return tl::make_unexpected(arrival.error());
    visit.macro_time_s += arrival->macro_time_s;
    visit.micro_time_s += arrival->micro_time_s;
    const auto frame = context.session.capture();
    if (!frame) return tl::make_unexpected(frame.error());
    const Measuring& by = context.measuring;
    return read_snapshot(*frame, by.camera, by.recipe.nominal, site.tag_id, by.detector);
}

/// Takes the pictures that are still missing. Fails with the first view's failure.
Status take_missing(const VisitContext& context, const Site& site, Snapshots& snapshots, Visit& visit) {
    for (std::size_t k = 0; k < site.views.size(); ++k) {
        if (snapshots[k]) continue;
        auto taken = take_snapshot(context, site, site.views[k], visit);
        if (!taken) {
            const Reason reason = taken.error().reason;
            if (ends_the_run(reason)) stop_run(site, taken.error());
            visit.failures.push_back({site.views[k].name, std::string(name_of(reason)), taken.error().text});
            return tl::make_unexpected(taken.error());
        }
        snapshots[k] = std::move(*taken);
    }
    return {};
}

/// "view left failed 1 of 2 tries (no_tag: ...)": why a site took more than one try.
std::string history(const Visit& visit) {
    if (visit.failures.empty()) return {};
    const FailedAttempt& last = visit.failures.back();
    return fmt::format("view {} failed {} of {} tries ({}: {})", last.view, visit.failures.size(),
                       visit.failures.size() + (visit.end == Visit::End::measured ? 1 : 0), last.reason,
                       last.text);
}

}  // namespace

Visit visit_site(const VisitContext& context, const NextVisit& next) {
    const Site& site = *next.site;
    Visit visit{};
    visit.site = site.tag_id;
    visit.again = next.again;
    visit.recording = recording_name(site.tag_id, next.again);
    const std::filesystem::path recording = context.measuring.output.root / visit.recording;
    set_aside(recording);
    context.session.record_to(recording, context.measuring.recipe.name);
    visit.from_s = context.session.now_s();

    Snapshots snapshots(site.views.size());
    visit.end = Visit::End::measured;
    while (true) {
        const Status taken = take_missing(context, site, snapshots, visit);
        if (taken) break;
        if (puts_rig_in_doubt(taken.error().reason) || context.session.camera_is_in_doubt())
            if (const auto well = context.session.check_rig(); !well) stop_run(site, well.error());
        const Remedy remedy =
            remedy_for(site.on_failure, static_cast<int>(visit.failures.size()), next.again);
        if (remedy == Remedy::retry) continue;
        visit.end = remedy == Remedy::defer ? Visit::End::deferred : Visit::End::skipped;
        break;
    }
    visit.to_s = context.session.now_s();
    if (const auto closed = context.session.end_recording(); !closed) stop_run(site, closed.error());
    if (visit.end != Visit::End::deferred)
        measure_site(
            context.measuring, site, snapshots, [why = history(visit)](const View&) { return why; }, visit);
    return visit;
}

}  // namespace fidservo::inspect
