// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/report/report_sections.h"
#include "src/report/html.h"
#include "vision/images/image_file.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

using report::escaped;

constexpr int jpeg_quality = 72;

std::string_view class_of(const Overlay& overlay) {
    if (overlay.kind == Overlay::Kind::fiducial) return "fiducial";
    return overlay.outcome == Outcome::pass ? "good" : overlay.outcome == Outcome::fail ? "bad" : "unsure";
}

std::string shape(const Overlay& overlay) {
    std::string points;
    Eigen::Vector2d highest = overlay.points_px.front();
    for (const Eigen::Vector2d& point : overlay.points_px) {
        points += fmt::format("{:.1f},{:.1f} ", point.x() + 0.5, point.y() + 0.5);
        if (point.y() < highest.y()) highest = point;
    }
    return fmt::format(
        "<{} class=\"{}{}\" points=\"{}\"><title>{}</title></{}><text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>",
        overlay.closed ? "polygon" : "polyline", class_of(overlay),
        overlay.kind == Overlay::Kind::defect ? " defect" : "", points, escaped(overlay.label),
        overlay.closed ? "polygon" : "polyline", std::max(4.0, highest.x()),
        std::max(20.0, highest.y() - 6.0), escaped(overlay.label));
}

/// The image as inline JPEG with its overlays; pixel centres at integers, so the drawing is shifted by half.
std::string shot(const OutputFolder& output, const CameraGeometry& camera, const Visit& visit,
                 const ViewResult& view) {
    const auto grey = vision::read_grey(output.root / view.image);
    const std::vector<unsigned char> jpeg =
        grey ? vision::encode_jpeg(*grey, jpeg_quality) : std::vector<unsigned char>();
    std::string html = fmt::format(
        "<figure><button class=\"shot\" type=\"button\" aria-label=\"enlarge\"><img alt=\"site {}, view {}\" "
        "loading=\"lazy\" width=\"{}\" height=\"{}\" "
        "src=\"data:image/jpeg;base64,{}\"><svg viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\">",
        visit.site, escaped(view.view), camera.width_px, camera.height_px, report::base64(jpeg),
        camera.width_px, camera.height_px);
    for (const Overlay& overlay : view.overlays) html += shape(overlay);
    return html +
           fmt::format("</svg></button><figcaption>{} \u00b7 axis at x {:.3f} mm</figcaption></figure>",
                       escaped(view.view), view.axis_x_mm);
}

std::string card(const OutputFolder& output, const CameraGeometry& camera, const Visit& visit) {
    const Outcome outcome = outcome_of(visit);
    static constexpr const char* classes[] = {"good", "bad", "unsure", "neutral"};
    std::string html =
        fmt::format("<article class=\"card {}\" id=\"site-{}\"><h3>Site {} {}</h3><div class=\"views\">",
                    classes[static_cast<int>(outcome)], visit.site, visit.site, badge(outcome));
    for (const ViewResult& view : visit.views) html += shot(output, camera, visit, view);
    html += "</div>";
    std::string list;
    for (const ResultRow& row : visit.rows)
        if (row.verdict != Outcome::pass)
            list += fmt::format("<li>{}: {}{}{}</li>", escaped(row.feature), escaped(row.check),
                                row.value ? fmt::format(" {} \u00b5m", report::number(*row.value, 1)) : "",
                                row.reason.empty() ? "" : ", " + escaped(row.reason));
    for (const FailedAttempt& failed : visit.failures)
        list += fmt::format("<li>try failed in view {}: {}: {}</li>", escaped(failed.view), failed.reason,
                            escaped(failed.text));
    return html + (list.empty() ? "" : "<ul>" + list + "</ul>") + "</article>\n";
}

}  // namespace

std::string sites_html(const OutputFolder& output, const CameraGeometry& camera,
                       const std::vector<Visit>& visits) {
    std::string html =
        "<form class=\"filters\"><label><input type=\"checkbox\" id=\"overlay-toggle\" checked> show what "
        "was measured</label>"
        "<span class=\"hint\">Click an image to enlarge it. Blue: fiducials; green: passed; red: failed; "
        "amber: not decidable; dashed: defects.</span></form>\n<div class=\"sites\">";
    for (const Outcome first : {Outcome::fail, Outcome::not_measured, Outcome::not_decidable, Outcome::pass})
        for (const Visit& visit : visits)
            if (visit.end != Visit::End::deferred && outcome_of(visit) == first)
                html += card(output, camera, visit);
    return html + "</div>\n";
}

}  // namespace fidservo::inspect
