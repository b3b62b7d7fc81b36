// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/report/inspection_report.h"

#include "core/rig.h"
#include "src/files/disk/durable_file.h"
#include "src/inspect/report/report_sections.h"
#include "src/inspect/report/report_traces.h"
#include "src/inspect/saved_images.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

std::string headline(std::size_t sites, std::size_t failed, std::size_t unsure) {
    if (failed + unsure == 0) return fmt::format("Passed: all {} sites are within tolerance.", sites);
    if (failed == 0)
        return fmt::format("Not passed: {} of {} sites could not be decided or measured.", unsure, sites);
    std::string text =
        fmt::format("Failed: {} of {} sites {} out of tolerance", failed, sites, failed == 1 ? "is" : "are");
    if (unsure > 0) text += fmt::format(", {} could not be decided or measured", unsure);
    return text + ".";
}

}  // namespace

InspectionReport inspection_report(const OutputFolder& output, const Recipe& recipe, const Rig& rig,
                                   const JournalContent& content, const DeviceFigures& devices) {
    const std::vector<Visit>& visits = content.visits;
    const Counts counts = count(visits);
    std::size_t failed = 0, unsure = 0;
    for (const Visit& visit : visits) {
        if (visit.end == Visit::End::deferred) continue;
        const Outcome outcome = outcome_of(visit);
        failed += outcome == Outcome::fail;
        unsure += outcome == Outcome::not_decidable || outcome == Outcome::not_measured;
    }
    const CameraGeometry& camera = rig.camera.value().geometry;
    InspectionReport all;
    report::Page& page = all.page;
    page.title = recipe.name + " \u2013 inspection";
    page.kind = "Inspection report \u00b7 " + recipe.name;
    page.headline = headline(recipe.sites.size(), failed, unsure);
    page.mood = failed > 0 ? report::Mood::bad : unsure > 0 ? report::Mood::unsure : report::Mood::good;
    const auto measured_again = images_folder(content.identity.camera);
    page.subline = fmt::format("{} checks at {} sites on ", counts.total(), recipe.sites.size()) +
                   (measured_again ? fmt::format("the images in {}, which were measured again.",
                                                 measured_again->string())
                                   : fmt::format("rig {} in {:.0f} s of rig time{}.", rig.name,
                                                 visits.empty() ? 0.0 : visits.back().to_s,
                                                 content.identity.stage == "sim" ? ", simulated" : ""));
    page.figures = {
        {std::to_string(counts.pass), "checks passed", report::Mood::good},
        {std::to_string(counts.fail), "failed", counts.fail > 0 ? report::Mood::bad : report::Mood::neutral},
        {std::to_string(counts.not_decidable), "not decidable",
         counts.not_decidable > 0 ? report::Mood::unsure : report::Mood::neutral},
        {std::to_string(counts.not_measured), "not measured",
         counts.not_measured > 0 ? report::Mood::unsure : report::Mood::neutral}};
    page.body = report::section("plate", "Plate", plate_html(recipe, camera, visits));
    if (counts.pass < counts.total())
        page.body += report::section("findings", "Findings", findings_html(visits));
    page.body += report::section("sites", "Sites", sites_html(output, camera, visits));
    page.body += report::section("errors", "Deviations", histogram_html(visits));
    if (!measured_again) page.body += report::section("traces", "Stage", traces_html(output, rig, visits));
    all.findings_at = page.body.size();
    if (devices.loop) page.body += report::section("loop", "Control loop", loop_html(*devices.loop));
    if (devices.frames) page.body += report::section("frames", "Camera frames", frames_html(*devices.frames));
    page.body += report::section("checks", "All checks", checks_html(visits));
    page.footer = footer_html(content);
    return all;
}

InspectionReport with_findings(InspectionReport all, const RigFindings& findings) {
    all.page.body.insert(all.findings_at, report::section("rig", "The rig", findings.html));
    return all;
}

void write_inspection_report(const OutputFolder& output, const InspectionReport& all) {
    replace_file(output.report(), report::render(all.page));
}

}  // namespace fidservo::inspect
