// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "core/units.h"
#include "src/calibrate/calibrate_stage.h"
#include "src/calibrate/stage_values.h"
#include "src/report/html.h"
#include "src/report/page.h"
#include "src/report/xy_chart.h"

#include <cmath>

#include <fmt/format.h>

namespace fidservo {

namespace {

using report::escaped;

std::string figure(const std::string& caption, const std::string& svg) {
    return fmt::format("{}<p class=\"caption\">{}</p>\n", svg, escaped(caption));
}

std::string stage_values_table(const Rig& rig, const StageNumbers& numbers) {
    std::string html =
        "<div class=\"scroll\"><table id=\"values\"><thead><tr><th>Quantity</th><th class=\"n\">Value and "
        "standard error</th><th>Unit</th><th class=\"n\">Rig file</th><th class=\"n\">Change, standard "
        "errors</th></tr></thead><tbody>\n";
    for (const StageValue& value : stage_values(rig, numbers))
        html += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{}</td><td>{}</td><td class=\"n\">{}</td><td "
            "class=\"n\">{}</td></tr>\n",
            escaped(value.key), escaped(with_std(value)), escaped(value.unit),
            value.in_rig_file ? fmt::format("{:.8g}", value.file) : "\u2013",
            value.in_rig_file ? report::number((value.value - value.file) / value.std, 1) : "\u2013");
    return html + "</tbody></table></div>\n";
}

std::string tests_table(const std::vector<FreshTest>& tests) {
    std::string html =
        "<div class=\"scroll\"><table id=\"fresh\"><thead><tr><th>Error</th><th class=\"n\">Number</th><th "
        "class=\"n\">r.m.s.</th><th class=\"n\">promised</th><th class=\"n\">worst</th><th "
        "class=\"n\">allowed</th><th>Unit</th><th>Verdict</th></tr></thead><tbody>\n";
    for (const FreshTest& test : tests)
        html += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.4g}</td><td class=\"n\">{:.4g}</td><td "
            "class=\"n\">{:.4g}</td><td class=\"n\">{:.4g}</td><td>{}</td><td class=\"{}\"><span "
            "class=\"badge\">{}</span></td></tr>\n",
            escaped(test.what), test.errors, test.rms, test.promised_rms, test.worst, test.allowed_worst,
            test.unit, test.passed ? "good" : "bad", test.passed ? "passed" : "failed");
    return html + "</tbody></table></div>\n";
}

/// Corner residuals over their place in the image, and where in the image corners were seen.
std::string picture_charts(const StageCalibration& calibration) {
    report::XyCurve across{"along u", {}, {}, true}, down{"along v", {}, {}, true};
    std::vector<report::XyCurve> seen{{"fitted", {}, {}, true}, {"fresh", {}, {}, true}};
    for (const StageShot& shot : calibration.shots) {
        const double s_mm = calib::check_view(calibration.numbers.map, shot.tags).s_mm;
        const auto residuals = calib::residuals_px(calibration.numbers.map, shot.tags, s_mm);
        for (std::size_t k = 0; k < shot.tags.size(); ++k)
            for (std::size_t c = 0; c < 4; ++c) {
                const Eigen::Vector2d& corner = shot.tags[k].corners_px[c];
                across.x.push_back(corner.x());
                across.y.push_back(residuals[k][c].x());
                down.x.push_back(corner.x());
                down.y.push_back(residuals[k][c].y());
                report::XyCurve& places = seen[is_fresh(shot) ? 1 : 0];
                places.x.push_back(corner.x());
                places.y.push_back(-corner.y());
            }
    }
    return figure(
               "Corners seen minus corners expected, over the corner's place in the image. A bend would be a "
               "lens that the map does not describe, a slope a wrong scale.",
               report::xy_chart_svg("u, px", "residual, px", {across, down})) +
           figure("Where in the image corners were seen; v is turned round, so that up is up.",
                  report::xy_chart_svg("u, px", "-v, px", seen));
}

std::vector<StandResidual> residuals_of(const StageCalibration& calibration, bool fresh) {
    if (!fresh) return calibration.numbers.residuals;
    std::vector<StandResidual> residuals;
    for (const StageShot& shot : calibration.shots)
        if (is_fresh(shot))
            residuals.push_back(residual_of(calibration.numbers, shot,
                                            calib::check_view(calibration.numbers.map, shot.tags).s_mm));
    return residuals;
}

std::string stand_charts(const StageCalibration& calibration) {
    std::vector<report::XyCurve> hall{{"fitted", {}, {}, true}, {"fresh", {}, {}, true}};
    std::vector<report::XyCurve> encoder = hall;
    for (const std::size_t fresh : {0, 1})
        for (const StandResidual& residual : residuals_of(calibration, fresh == 1)) {
            if (std::isfinite(residual.hall_error_mm)) {
                hall[fresh].x.push_back(residual.platform_mm);
                hall[fresh].y.push_back(um_from_mm(residual.hall_error_mm));
            }
            if (std::isfinite(residual.count_error)) {
                encoder[fresh].x.push_back(residual.s_mm);
                encoder[fresh].y.push_back(residual.count_error);
            }
        }
    return figure("The platform by its Hall sensor minus by the camera, over the platform's place.",
                  report::xy_chart_svg("platform, mm", "error, um", hall)) +
           figure(
               "The encoder's count minus the carriage's exact place in counts: half a count at "
               "most; many stands are at its edge, where the drive stops.",
               report::xy_chart_svg("camera position, mm", "error, counts", encoder));
}

}  // namespace

std::string stage_report(const Rig& rig, const StageCalibration& calibration) {
    const StageNumbers& numbers = calibration.numbers;
    const bool passed = calibration.passed();
    report::Page page;
    page.title = rig.name + " \u2013 stage calibration";
    page.kind = "Stage calibration \u00b7 " + rig.name;
    page.headline = fmt::format("The calibration {} on fresh moves what its standard errors promise.",
                                passed ? "keeps" : "does not keep");
    page.mood = passed ? report::Mood::good : report::Mood::bad;
    page.subline = fmt::format("{} stands in {:.0f} s of rig time; {} of them were kept for the check.",
                               calibration.shots.size(), calibration.rig_time_s,
                               calibration.shots.size() - numbers.mapped.size());
    page.figures = {{fmt::format("{:.6f} um", 1e3 / numbers.map.scale_px_per_mm()), "a pixel on the plate"},
                    {fmt::format("{:.3f} mrad", 1e3 * numbers.map.camera.rotation_rad), "camera rotation"},
                    {fmt::format("{:.5f} um", um_from_mm(numbers.encoder.resolution_mm)), "an encoder count"},
                    {fmt::format("{:.5f}", numbers.hall_scale), "plate mm per Hall mm"}};
    for (const FreshTest& test : calibration.tests)
        page.figures.push_back({fmt::format("{:.3g} {}", test.rms, test.unit), test.what + ", fresh r.m.s.",
                                test.passed ? report::Mood::good : report::Mood::bad});
    std::string notes = "<ul>";
    for (const std::string& note : stage_notes(numbers)) notes += "<li>" + escaped(note) + "</li>";
    page.body = report::section("numbers", "Numbers", stage_values_table(rig, numbers) + notes + "</ul>") +
                report::section("check", "Check on fresh moves", tests_table(calibration.tests)) +
                report::section("pictures", "Tags in the image", picture_charts(calibration)) +
                report::section("stage", "Platform and carriage", stand_charts(calibration));
    return report::render(page);
}

}  // namespace fidservo
