// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/report/report_sections.h"

#include "core/rig.h"
#include "src/inspect/recipe/seen_box.h"
#include "src/report/chart.h"
#include "src/report/html.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

using report::escaped;
using report::number;

std::string_view sign_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::pass:
            return "\u2713";
        case Outcome::fail:
            return "\u2717";
        case Outcome::not_decidable:
            return "?";
        case Outcome::not_measured:
            return "\u2013";
    }
    return "";
}

std::string words(std::string_view name) {
    std::string text(name);
    std::ranges::replace(text, '_', ' ');
    return text;
}

std::string shown(const std::optional<double>& value, int digits = 2) {
    return value ? number(*value, digits) : std::string("\u2013");
}

std::string options_html(const std::set<std::string>& values) {
    std::string html;
    for (const std::string& value : values)
        html += fmt::format("<option value=\"{0}\">{1}</option>", escaped(value), escaped(words(value)));
    return html;
}

}  // namespace

report::Mood mood_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::pass:
            return report::Mood::good;
        case Outcome::fail:
            return report::Mood::bad;
        case Outcome::not_decidable:
            return report::Mood::unsure;
        case Outcome::not_measured:
            return report::Mood::neutral;
    }
    return report::Mood::neutral;
}

std::string badge(Outcome outcome) {
    return fmt::format("<span class=\"badge {}\">{} {}</span>", report::class_of(mood_of(outcome)),
                       sign_of(outcome), words(name_of(outcome)));
}

std::string findings_html(const std::vector<Visit>& visits) {
    std::string html =
        "<div class=\"scroll\"><table><thead><tr><th>Site</th><th>Check</th><th>Feature</th><th "
        "class=\"n\">Value</th>"
        "<th class=\"n\">Nominal</th><th class=\"n\">Tolerance</th><th>Verdict</th><th>What was "
        "found</th></tr></thead><tbody>";
    for (const Visit& visit : visits)
        for (const ResultRow& row : visit.rows)
            if (row.verdict != Outcome::pass)
                html += fmt::format(
                    "<tr><td><a href=\"#site-{0}\">{0}</a></td><td>{1}</td><td>{2}</td><td "
                    "class=\"n\">{3}</td>"
                    "<td class=\"n\">{4}</td><td class=\"n\">{5}</td><td>{6}</td><td "
                    "class=\"wide\">{7}</td></tr>",
                    row.site, words(row.check), escaped(row.feature), shown(row.value), shown(row.nominal),
                    shown(row.tolerance), badge(row.verdict), escaped(row.reason));
    return html + "</tbody></table></div>\n<p class=\"hint\">Lengths in \u00b5m.</p>";
}

std::string plate_html(const Recipe& recipe, const CameraGeometry& camera, const std::vector<Visit>& visits) {
    Eigen::Array2d low = recipe.nominal.tags.front().centre_mm, high = low;
    for (const PlateTag& tag : recipe.nominal.tags) {
        low = low.min(tag.centre_mm.array());
        high = high.max(tag.centre_mm.array());
    }
    const double margin = 4.0, width = high.x() - low.x() + 2 * margin,
                 height = high.y() - low.y() + 2 * margin;
    std::string svg = fmt::format(
        "<div class=\"scroll\"><svg class=\"plate\" viewBox=\"{:.2f} {:.2f} {:.2f} {:.2f}\">"
        "<rect class=\"sheet\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
        "stroke-width=\".1\"/>",
        low.x() - margin, low.y() - margin, width, height, low.x() - margin + .1, low.y() - margin + .1,
        width - .2, height - .2);
    for (const PlateTag& tag : recipe.nominal.tags)
        svg +=
            fmt::format("<rect class=\"tag\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>",
                        tag.centre_mm.x() - tag.side_mm / 2, tag.centre_mm.y() - tag.side_mm / 2, tag.side_mm,
                        tag.side_mm);
    for (const Visit& visit : visits) {
        if (visit.end == Visit::End::deferred) continue;
        const auto site = std::ranges::find(recipe.sites, visit.site, &Site::tag_id);
        Eigen::Array2d seen_low = site->fiducial_mm, seen_high = seen_low;
        for (const View& view : site->views) {
            const Box seen = box_around_seen(camera, site->fiducial_mm.x() + view.offset_um / 1000);
            seen_low = seen_low.min(seen.low_mm.array());
            seen_high = seen_high.max(seen.high_mm.array());
        }
        const Outcome outcome = outcome_of(visit);
        svg += fmt::format(
            "<a href=\"#site-{0}\"><g class=\"site {1}\"><rect x=\"{2:.2f}\" y=\"{3:.2f}\" width=\"{4:.2f}\" "
            "height=\"{5:.2f}\" rx=\".5\" style=\"stroke-width:.2\"/><text x=\"{6:.2f}\" y=\"{7:.2f}\" "
            "style=\"font-size:1.9px\">{8} {0}</text>"
            "<title>site {0}: {9}</title></g></a>",
            visit.site, report::class_of(mood_of(outcome)), seen_low.x(), seen_low.y(),
            seen_high.x() - seen_low.x(), seen_high.y() - seen_low.y(), (seen_low.x() + seen_high.x()) / 2,
            seen_low.y() - .4, sign_of(outcome), words(name_of(outcome)));
    }
    return svg +
           "</svg></div>\n<p class=\"hint\">Each box is what the camera saw at a site; its number is that of "
           "its fiducial.</p>";
}

std::string checks_html(const std::vector<Visit>& visits) {
    std::set<std::string> sites, checks, verdicts;
    std::string rows;
    for (const Visit& visit : visits)
        for (const ResultRow& row : visit.rows) {
            sites.insert(fmt::format("{:03}", row.site));
            checks.insert(row.check);
            verdicts.insert(std::string(name_of(row.verdict)));
            rows += fmt::format(
                "<tr data-site=\"{:03}\" data-check=\"{}\" data-verdict=\"{}\"><td class=\"n\"><a "
                "href=\"#site-{}\">{}</a></td>"
                "<td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
                "class=\"n\">{}</td>"
                "<td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td><td class=\"wide\">{}</td></tr>\n",
                row.site, row.check, name_of(row.verdict), row.site, row.site, escaped(row.view),
                words(row.check), escaped(row.feature), shown(row.value), shown(row.uncertainty, 3),
                shown(row.nominal),
                row.value && row.nominal ? number(*row.value - *row.nominal, 2) : "\u2013",
                shown(row.tolerance), badge(row.verdict), escaped(row.reason));
        }
    return "<form class=\"filters\" data-table=\"checks-table\"><label>Site <select name=\"site\"><option "
           "value=\"\">all</option>" +
           options_html(sites) +
           "</select></label><label>Check <select name=\"check\"><option value=\"\">all</option>" +
           options_html(checks) +
           "</select></label><label>Verdict <select name=\"verdict\"><option value=\"\">all</option>" +
           options_html(verdicts) +
           "</select></label><label>Text <input name=\"text\" "
           "type=\"search\"></label><output></output></form>\n"
           "<div class=\"scroll tall\"><table id=\"checks-table\"><thead><tr><th "
           "class=\"n\">Site</th><th>View</th><th>Check</th><th>Feature</th>"
           "<th class=\"n\">Value</th><th class=\"n\">u</th><th class=\"n\">Nominal</th><th "
           "class=\"n\">Deviation</th>"
           "<th class=\"n\">Tolerance</th><th>Verdict</th><th>Remark</th></tr></thead><tbody>\n" +
           rows +
           "</tbody></table></div>\n<p class=\"hint\">Lengths in \u00b5m; places are counted from the site's "
           "fiducial. u: standard uncertainty. "
           "A check passes if its deviation lies within the tolerance by at least 2 u, fails if it lies "
           "outside by more than 2 u, and is not decidable in between.</p>";
}

std::string histogram_html(const std::vector<Visit>& visits) {
    constexpr double low = -1.5, bin_width = 0.1;
    constexpr int bins = 30;
    std::map<std::string, std::vector<int>> counts;
    for (const Visit& visit : visits)
        for (const ResultRow& row : visit.rows) {
            if (!row.value || !row.nominal || !row.tolerance || row.check == "reference") continue;
            const double part = (*row.value - *row.nominal) / *row.tolerance;
            const int bin = std::clamp(static_cast<int>(std::floor((part - low) / bin_width)), 0, bins - 1);
            auto& of_kind = counts[words(row.check.substr(0, row.check.find('_')))];
            of_kind.resize(bins);
            ++of_kind[static_cast<std::size_t>(bin)];
        }
    if (counts.empty()) return "<p>Nothing was measured.</p>";
    report::Histogram histogram{"deviation / tolerance (the outermost bars hold everything beyond)",
                                low,
                                bin_width,
                                {},
                                {},
                                {-1.0, 1.0}};
    for (const auto& [kind, of_kind] : counts) {
        histogram.kinds.push_back(kind);
        histogram.counts.push_back(of_kind);
    }
    return report::histogram_svg(histogram);
}

std::string footer_html(const JournalContent& content) {
    const RunIdentity& id = content.identity;
    std::string html = fmt::format(
        "<table><tr><td>Program</td><td>fidservo {}</td></tr><tr><td>Stage, camera</td><td>{}, {}</td></tr>"
        "<tr><td>Seed</td><td>{}</td></tr>",
        escaped(id.version), escaped(id.stage), escaped(id.camera), id.seed);
    for (const auto& [name, hash] :
         {std::pair("Recipe", id.recipe_sha256), std::pair("Rig", id.rig_sha256),
          std::pair("Nominal plate", id.plate_sha256), std::pair("Simulated plate", id.printed_sha256),
          std::pair("Calibration", id.calibration_sha256)})
        if (!hash.empty())
            html += fmt::format("<tr><td>{}</td><td>SHA-256 <code>{}</code></td></tr>", name, hash);
    return html + "</table>";
}

}  // namespace fidservo::inspect
