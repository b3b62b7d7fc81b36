// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/reproduce/reproduce.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/rig_file.h"
#include "src/process/commit.h"
#include "src/process/progress.h"
#include "src/report/html.h"
#include "src/report/page.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

constexpr std::array chapters{open_loop_macro, wire_hysteresis, heater,      hall_sensor,
                              benchmark_pid,   nonlinear_pd,    micro_steps, micro_bandwidth,
                              integrated_task, beyond_model};

void demand_published_parts(const Rig& rig, const std::filesystem::path& rig_file) {
    const auto demand = [&](bool there, const char* key) {
        if (!there)
            throw InputError(
                fmt::format("{}: {}: missing; the published experiments need it", rig_file.string(), key));
    };
    demand(rig.macro.pd.has_value(), "macro.pd");
    demand(rig.macro.pid.has_value(), "macro.pid");
    demand(rig.micro.has_value(), "micro");
    demand(rig.micro->pi.has_value(), "micro.pi");
    demand(rig.camera.has_value(), "camera");
    demand(rig.fiducials.has_value(), "fiducials");
}

report::Mood mood_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::holds:
            return report::Mood::good;
        case Outcome::rig_differs:
            return report::Mood::unsure;
        case Outcome::fails:
            return report::Mood::bad;
    }
    return report::Mood::neutral;
}

std::string claims_table(const std::vector<Chapter>& written) {
    std::string html =
        "<div class=\"scroll\"><table "
        "id=\"claims-table\"><thead><tr><th>Where</th><th>Claim</th><th>Measured here</th>"
        "<th>Outcome</th><th>Why not</th></tr></thead><tbody>\n";
    for (const Chapter& chapter : written)
        for (const Claim& claim : chapter.claims)
            html += fmt::format(
                "<tr><td><a href=\"#{}\">{}</a></td><td class=\"wide\">{}</td><td class=\"wide\">{}</td>"
                "<td class=\"{}\"><span class=\"badge\">{}</span></td><td class=\"wide\">{}</td></tr>\n",
                chapter.id, report::escaped(claim.source), report::escaped(claim.claim),
                report::escaped(claim.measured), report::class_of(mood_of(claim.outcome)),
                name_of(claim.outcome), report::escaped(claim.outcome == Outcome::holds ? "" : claim.why));
    return html + "</tbody></table></div>\n";
}

std::string quoted(const std::string& text) {
    std::string field = "\"";
    for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
    return field + '"';
}

std::string claims_csv(const std::vector<Claim>& claims) {
    std::string csv = "source,claim,measured,outcome,why\n";
    for (const Claim& claim : claims)
        csv +=
            fmt::format("{},{},{},{},{}\n", quoted(claim.source), quoted(claim.claim), quoted(claim.measured),
                        name_of(claim.outcome), quoted(claim.outcome == Outcome::holds ? "" : claim.why));
    return csv;
}

report::Page page_of(const std::vector<Chapter>& written, const std::vector<Claim>& claims, const Rig& rig,
                     std::uint64_t seed) {
    const auto count = [&](Outcome outcome) { return std::ranges::count(claims, outcome, &Claim::outcome); };
    const auto holding = count(Outcome::holds), differing = count(Outcome::rig_differs),
               failing = count(Outcome::fails);
    report::Page page;
    page.title = "The published system, reproduced";
    page.kind = "Reproduction report \u00b7 " + rig.name;
    page.headline =
        failing == 0
            ? fmt::format("{} of {} claims hold; in {} the reference rig differs, as the table says why.",
                          holding, claims.size(), differing)
            : fmt::format("{} of {} claims do not hold.", failing, claims.size());
    page.mood = failing == 0 ? report::Mood::good : report::Mood::bad;
    page.subline =
        "Every experiment of the published macro-micro stage, run on an independent model of the rig that "
        "the identification "
        "and the controllers have not seen.";
    page.figures = {{std::to_string(holding), "claims hold", mood_of(Outcome::holds)},
                    {std::to_string(differing), "the rig differs", mood_of(Outcome::rig_differs)},
                    {std::to_string(failing), "do not hold",
                     failing > 0 ? mood_of(Outcome::fails) : report::Mood::neutral}};
    page.body = report::section("claims", "Claims", claims_table(written));
    for (const Chapter& chapter : written)
        page.body += report::section(chapter.id, chapter.heading, chapter.html);
    page.footer = fmt::format(
        "<p>fidservo {}, rig {}, seed {}. The recordings behind each figure are in recordings/.</p>",
        program_version(), report::escaped(rig.name), seed);
    return page;
}

}  // namespace

std::string_view name_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::holds:
            return "holds";
        case Outcome::rig_differs:
            return "the rig differs";
        case Outcome::fails:
            return "does not hold";
    }
    return "";
}

std::vector<Claim> reproduce(const std::filesystem::path& rig_file, const std::filesystem::path& out,
                             std::uint64_t seed) {
    const Laboratory laboratory{load_rig(rig_file), rig_file, out, seed};
    demand_published_parts(laboratory.rig, rig_file);
    std::vector<Chapter> written;
    written.reserve(chapters.size());
    Progress progress("chapters", chapters.size());
    for (const auto& chapter : chapters) {
        written.push_back(chapter(laboratory));
        progress.advance();
    }
    progress.finish();
    std::vector<Claim> claims;
    for (const Chapter& chapter : written)
        claims.insert(claims.end(), chapter.claims.begin(), chapter.claims.end());
    write_or_throw(out / "claims.csv", claims_csv(claims));
    write_or_throw(out / "report.html", report::render(page_of(written, claims, laboratory.rig, seed)));
    return claims;
}

}  // namespace fidservo::reproduce
