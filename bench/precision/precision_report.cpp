// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/precision/precision_report.h"

#include "bench/precision/log_chart.h"
#include "src/report/html.h"
#include "src/report/page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::bench {
namespace {

using precision::AxisFigures;
using precision::PrecisionCase;
using precision::PrecisionFigures;
using report::escaped;
using report::number;

constexpr std::array colours{"#1f5fa8", "#4b9be0", "#d9730d", "#a36a00",
                             "#3f9a5b", "#8a5bc0", "#b0457a", "#5b6770"};
constexpr double nm_per_px = 4000.0;  // 4 um on the plate

double bound_px(const PrecisionFigures& figures) {
    return std::sqrt(0.5 * (std::pow(figures.u.bound_px, 2) + std::pow(figures.v.bound_px, 2)));
}

bool mostly_answers(const PrecisionFigures& figures) {
    return 2 * figures.failed < figures.trials;
}

std::string time_chart(const std::vector<MethodFigures>& methods) {
    std::vector<LogSeries> series;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        LogSeries one{methods[m].name, colours.at(m % colours.size()), {}};
        for (std::size_t k = 0; k < methods[m].cases.size(); ++k) {
            const PrecisionFigures& figures = methods[m].cases[k];
            if (!mostly_answers(figures)) continue;
            one.points.push_back({figures.median_ms, rms_px(figures),
                                  fmt::format("{}, {}: {:.5f} px, {:.2f} ms", methods[m].name, figures.name,
                                              rms_px(figures), figures.median_ms),
                                  k == 0});
        }
        series.push_back(one);
    }
    return log_chart_svg("processor time per frame, ms (one core, 640 x 480)",
                         "error of the tag's centre, px r.m.s.", series,
                         {"Cramér-Rao bound of the sharp picture", bound_px(methods.front().cases.front())});
}

std::string cell(const std::string& text, bool numeric = true) {
    return fmt::format("<td{}>{}</td>", numeric ? " class=\"n\"" : "", text);
}

std::string verdict(bool kept) {
    return fmt::format("<span class=\"badge {}\">{}</span>",
                       report::class_of(kept ? report::Mood::good : report::Mood::bad),
                       kept ? "kept" : "missed");
}

std::string limits_table(const std::vector<PrecisionCase>& cases, const MethodFigures& refinement) {
    std::string html =
        "<div class=\"scroll\"><table><thead><tr><th>Picture</th><th class=\"n\">Bound</th>"
        "<th class=\"n\">σ<sub>u</sub> / bound</th><th class=\"n\">σ<sub>v</sub> / bound</th>"
        "<th class=\"n\">Limit</th><th class=\"n\">Bias u</th><th class=\"n\">Bias v</th><th "
        "class=\"n\">Limit</th>"
        "<th class=\"n\">Between pixels u</th><th class=\"n\">v</th><th class=\"n\">Normalised error²</th>"
        "<th class=\"n\">99 %</th><th class=\"n\">Failed</th><th>Limits</th></tr></thead><tbody>";
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const PrecisionFigures& f = refinement.cases[k];
        const auto milli = [](double px) { return number(1e3 * px, 3); };
        html += "<tr>" + cell(escaped(f.name), false) + cell(milli(bound_px(f))) +
                cell(number(f.u.sigma_px / f.u.bound_px, 3)) + cell(number(f.v.sigma_px / f.v.bound_px, 3)) +
                cell(number(cases[k].limits.sigma_ratio, 1)) + cell(milli(f.u.bias_px)) +
                cell(milli(f.v.bias_px)) + cell(number(1e3 * cases[k].limits.bias_px, 0)) +
                cell(milli(f.u.first_harmonic_px)) + cell(milli(f.v.first_harmonic_px)) +
                cell(number(f.nees, 3)) + cell(fmt::format("{:.3f} – {:.3f}", f.nees_low, f.nees_high)) +
                cell(fmt::format("{}", f.failed)) +
                cell(verdict(reproaches(f, cases[k].limits, false).empty()), false) + "</tr>";
    }
    return html +
           "</tbody></table></div><p class=\"hint\">Lengths in 10⁻³ px. σ: standard deviation of the "
           "measured "
           "centre; bound: Cramér-Rao, of what is visible. A limit counts as kept if the 95 % limit of the "
           "figure "
           "is inside it. Between pixels: first harmonic of the error over the place between pixels. "
           "Normalised "
           "error²: mean of e' C⁻¹ e / 2 with the claimed covariance C; 1 if claims are true.</p>";
}

std::string peers_table(const std::vector<PrecisionCase>& cases, const std::vector<MethodFigures>& methods) {
    std::string html = "<div class=\"scroll\"><table><thead><tr><th>Picture</th>";
    for (const MethodFigures& method : methods) html += "<th class=\"n\">" + escaped(method.name) + "</th>";
    html += "</tr></thead><tbody>";
    for (std::size_t k = 0; k < cases.size(); ++k) {
        html += "<tr>" + cell(escaped(cases[k].name), false);
        for (const MethodFigures& method : methods) {
            const PrecisionFigures& f = method.cases[k];
            std::string text = mostly_answers(f) ? number(1e3 * rms_px(f), 2) : "not found";
            if (mostly_answers(f) && f.failed > 0)
                text += fmt::format(" ({:.0f} % failed)", std::ceil(100.0 * f.failed / f.trials));
            html += cell(text);
        }
        html += "</tr>";
    }
    html += "<tr>" + cell("<b>ms per frame</b>", false);
    for (const MethodFigures& method : methods) html += cell(number(method.cases.front().median_ms, 2));
    return html +
           "</tr></tbody></table></div><p class=\"hint\">Error of the tag's centre in 10⁻³ px r.m.s. of both "
           "coordinates, bias included, on the same frames. ECC and phase correlation are given a noiseless "
           "picture "
           "of the same tag; the refinement alone, a place known to 0.1 px; all others search the whole "
           "frame.</p>";
}

}  // namespace

double rms_px(const PrecisionFigures& figures) {
    double squares = 0.0;
    for (const AxisFigures& axis : {figures.u, figures.v})
        squares += 0.5 * (axis.sigma_px * axis.sigma_px + axis.bias_px * axis.bias_px);
    return std::sqrt(squares);
}

std::string precision_page(const std::vector<PrecisionCase>& cases, const std::vector<MethodFigures>& methods,
                           const FrameTimes& times) {
    const MethodFigures& refinement = methods.front();
    const PrecisionFigures& sharp = refinement.cases.front();
    int kept = 0, trials = 0;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        kept += reproaches(refinement.cases[k], cases[k].limits, false).empty() ? 1 : 0;
        trials += refinement.cases[k].trials;
    }
    const bool all = kept == static_cast<int>(cases.size());
    double best_peer_px = std::numeric_limits<double>::infinity();
    for (std::size_t m = 1; m < methods.size(); ++m)
        if (methods[m].name.find("fidservo") == std::string::npos && mostly_answers(methods[m].cases.front()))
            best_peer_px = std::min(best_peer_px, rms_px(methods[m].cases.front()));
    report::Page page;
    page.title = "fidservo: precision";
    page.kind = "Precision of the tag's place";
    page.headline = fmt::format("A tag is placed to {:.5f} px: {:.0f} % of the best that its light allows",
                                rms_px(sharp), 100.0 * bound_px(sharp) / rms_px(sharp));
    page.subline = fmt::format(
        "{} frames of {} kinds of picture: a tag of 320 px in 640 x 480, 0.8 px of blur, 10,000 electrons "
        "full well",
        trials, cases.size());
    page.mood = all ? report::Mood::good : report::Mood::bad;
    page.figures = {
        {fmt::format("{:.1f} nm", nm_per_px * rms_px(sharp)), "on the plate, at 4 µm a pixel"},
        {fmt::format("{:.2f} ms", times.refinement_ms), "refinement, one core"},
        {fmt::format("{:.0f} %", 100.0 * times.refinement_ms / times.detector_ms),
         "of the detector's time, 1280 x 960"},
        {fmt::format("{:.1f} times", best_peer_px / rms_px(sharp)), "as precise as the next method"},
        {fmt::format("{} of {}", kept, cases.size()), "kinds of picture within limits",
         all ? report::Mood::good : report::Mood::bad}};
    page.body =
        report::section(
            "chart", "Time against precision",
            time_chart(methods) +
                "<p class=\"caption\">Large dots: the sharp picture. Small dots: the other kinds, from "
                "defocus to damage, where the method found the tag at all. Lower left is better.</p>") +
        report::section("peers", "The same frames, other methods", peers_table(cases, methods)) +
        report::section("limits", "The refinement against its limits", limits_table(cases, refinement));
    page.footer = fmt::format(
        "1280 x 960, one tag of 320 px: refinement {:.3f} ms (median; p99 {:.3f} ms), libapriltag tuned "
        "{:.2f} ms.",
        times.refinement_ms, times.refinement_p99_ms, times.detector_ms);
    return report::render(page);
}

}  // namespace fidservo::bench
