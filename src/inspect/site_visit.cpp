#include "src/inspect/site_visit.h"

#include "core/units.h"
#include "src/recording/durable_file.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace fidservo::inspect {
namespace {

/// Snapshots of a site's views, in their order; empty where none has succeeded yet.
using Snapshots = std::vector<std::optional<Snapshot>>;

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
    return read_snapshot(*frame, context.camera, context.recipe.nominal, site.tag_id, context.detector);
}

/// What may be the rig's doing: then it has to show that it answers before a site is given up.
bool is_of_the_rig(Reason reason) {
    return reason == Reason::timeout || reason == Reason::no_convergence || reason == Reason::not_at_rest ||
           reason == Reason::out_of_reach;
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

void save_image(const std::filesystem::path& file, const cv::Mat& grey) {
    set_aside(file);
    std::vector<unsigned char> png;
    cv::imencode(".png", grey, png, {cv::IMWRITE_PNG_COMPRESSION, 3});
    replace_file(file, {reinterpret_cast<const char*>(png.data()), png.size()});
}

/// "measured at try 2 (no_tag: ...)": why a site took more than one try.
std::string history(const Visit& visit) {
    if (visit.failures.empty()) return {};
    const FailedAttempt& last = visit.failures.back();
    return fmt::format("view {} failed {} of {} tries ({}: {})", last.view, visit.failures.size(),
                       visit.failures.size() + (visit.end == Visit::End::measured ? 1 : 0), last.reason,
                       last.text);
}

void measure(const VisitContext& context, const Site& site, const Snapshots& snapshots, Visit& visit) {
    std::vector<Snapshot> taken;
    for (const auto& snapshot : snapshots)
        if (snapshot) taken.push_back(*snapshot);
    const std::string why = history(visit);
    for (std::size_t k = 0; k < site.views.size(); ++k) {
        const View& view = site.views[k];
        if (!snapshots[k]) {
            std::ranges::move(rows_not_measured(site, view, why), std::back_inserter(visit.rows));
            continue;
        }
        const std::string image = image_name(site.tag_id, visit.again, view.name);
        save_image(context.output.root / image, snapshots[k]->image.grey);
        CheckedView checked = check_view(
            {site, view, context.recipe.nominal, *snapshots[k], taken, context.draw_nominal, image});
        if (!why.empty())
            for (ResultRow& row : checked.rows) row.reason += (row.reason.empty() ? "" : "; ") + why;
        std::ranges::move(checked.rows, std::back_inserter(visit.rows));
        visit.views.push_back({view.name, image, snapshots[k]->image.axis_mm.x(),
                               snapshots[k]->image.axis_mm.y(), std::move(checked.overlays)});
    }
}

}  // namespace

Visit visit_site(const VisitContext& context, const NextVisit& next) {
    const Site& site = *next.site;
    Visit visit{};
    visit.site = site.tag_id;
    visit.again = next.again;
    visit.recording = recording_name(site.tag_id, next.again);
    set_aside(context.output.root / visit.recording);
    context.session.record_to(context.output.root / visit.recording, context.recipe.name);
    visit.from_s = context.session.now_s();

    Snapshots snapshots(site.views.size());
    visit.end = Visit::End::measured;
    while (true) {
        const Status taken = take_missing(context, site, snapshots, visit);
        if (taken) break;
        if (is_of_the_rig(taken.error().reason) || context.session.camera_is_in_doubt())
            if (const auto well = context.session.check_rig(); !well) stop_run(site, well.error());
        const Remedy remedy =
            remedy_for(site.on_failure, static_cast<int>(visit.failures.size()), next.again);
        if (remedy == Remedy::retry) continue;
        visit.end = remedy == Remedy::defer ? Visit::End::deferred : Visit::End::skipped;
        break;
    }
    visit.to_s = context.session.now_s();
    if (const auto closed = context.session.end_recording(); !closed) stop_run(site, closed.error());
    if (visit.end != Visit::End::deferred) measure(context, site, snapshots, visit);
    return visit;
}

}  // namespace fidservo::inspect
