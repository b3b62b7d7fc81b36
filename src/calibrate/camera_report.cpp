// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/camera_report.h"

#include "src/calibrate/camera_pictures.h"
#include "src/process/commit.h"
#include "src/report/html.h"
#include "src/report/page.h"
#include "src/report/xy_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr double deg = std::numbers::pi / 180.0;

struct Row {
    std::string key;
    double value, std;
    std::string_view unit;
};

std::vector<Row> rows_of(const CameraAnswer& answer) {
    using namespace calib;
    const Lens lens = lens_of(answer.calibration.camera);
    std::vector<Row> rows;
    for (std::size_t k = 0; k < lens_parameters; ++k)
        if (answer.calibration.fitted[k])
            rows.push_back({std::string(calib::name_of(static_cast<LensParameter>(k))), lens[k],
                            answer.calibration.std_of(static_cast<LensParameter>(k)),
                            k == focal || k == centre_u || k == centre_v ? " px" : ""});
    if (answer.noise) {
        rows.push_back({"full_well_e", answer.noise->full_well_e, answer.noise->full_well_std_e, " e"});
        rows.push_back({"read_noise_e", answer.noise->read_noise_e, answer.noise->read_noise_std_e, " e"});
        rows.push_back({"gain_spread", answer.noise->gain_spread, answer.noise->gain_spread_std, ""});
    }
    return rows;
}

/// As many digits as the standard error has two of.
int digits_for(double std) {
    if (!(std > 0.0)) return 6;
    return std::max(0, 1 - static_cast<int>(std::floor(std::log10(std))));
}

std::string lens_values_table(const CameraAnswer& answer) {
    std::string html =
        "<table><thead><tr><th>Value</th><th>Found</th><th>Standard error</th></tr></thead><tbody>";
    for (const Row& row : rows_of(answer))
        html += fmt::format("<tr><td>{}</td><td>{}{}</td><td>{}</td></tr>", row.key,
                            report::number(row.value, digits_for(row.std)), row.unit,
                            report::number(row.std, digits_for(row.std)));
    return html + "</tbody></table>";
}

std::string views_table(const calib::CameraCalibration& calibration) {
    std::string html =
        "<table><thead><tr><th>View</th><th>Tags</th><th>Left out</th><th>Tilt, degrees</th>"
        "<th>Distance, mm</th><th>Error, px</th></tr></thead><tbody>";
    for (const calib::ViewFit& view : calibration.views) {
        const CameraGeometry camera = calib::camera_at(calibration.camera, view.pose);
        const auto unused = std::ranges::count(view.tags, false, &calib::SightResidual::used);
        html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                            report::escaped(view.name), view.tags.size(), unused,
                            report::number(camera.tilt_rad.norm() / deg, 2),
                            report::number(camera.distance_mm, 3), report::number(view.rms_px, 4));
    }
    return html + "</tbody></table>";
}

std::string residual_chart(const calib::CameraCalibration& calibration) {
    report::XyCurve used{.name = "used", .x = {}, .y = {}, .dots = true};
    report::XyCurve unused{.name = "left out", .x = {}, .y = {}, .dots = true};
    for (const calib::ViewFit& view : calibration.views)
        for (const calib::SightResidual& tag : view.tags)
            for (const Eigen::Vector2d& error : tag.error_px) {
                report::XyCurve& curve = tag.used ? used : unused;
                curve.x.push_back(error.x());
                curve.y.push_back(error.y());
            }
    std::vector<report::XyCurve> curves{used};
    if (!unused.x.empty()) curves.push_back(unused);
    return report::xy_chart_svg("error along u, px", "error along v, px", curves);
}

std::string noise_section(const calib::PhotonTransfer& noise) {
    report::XyCurve measured{.name = "measured", .x = {}, .y = {}, .dots = true};
    report::XyCurve line{.name = "line", .x = {0.0, 255.0}, .y = {}, .dots = false};
    for (const calib::TransferPoint& point : noise.points) {
        measured.x.push_back(point.mean_grey);
        measured.y.push_back(point.variance);
    }
    const double gain = 255.0 / noise.full_well_e;
    for (const double grey : line.x)
        line.y.push_back(gain * grey + std::pow(gain * noise.read_noise_e, 2) + 1.0 / 12.0);
    return "<p>Variance of a pixel from frame to frame over its grey level: the slope is the gain, the floor "
           "read "
           "noise and rounding.</p>" +
           report::xy_chart_svg("mean, grey levels", "variance, grey levels squared", {measured, line});
}

std::string headline_of(const CameraAnswer& answer) {
    return answer.shortcomings.empty()
               ? fmt::format("Calibrated: corners are explained to {:.3g} px", answer.calibration.rms_px)
               : "Not good enough: " +
                     answer.shortcomings.front().substr(0, answer.shortcomings.front().find("; "));
}

}  // namespace

std::string describe(const CameraAnswer& answer) {
    std::string text =
        fmt::format("camera, from {} views in {} images of {}; {}\n", answer.calibration.views.size(),
                    answer.images, answer.source, answer.target);
    for (const Row& row : rows_of(answer)) {
        const int digits = digits_for(row.std);
        text += fmt::format("  {:<22}{:.{}f} +- {:.{}f}{}\n", row.key, row.value, digits, row.std, digits,
                            row.unit);
    }
    text += fmt::format("  {:<22}{:.3g} px r.m.s.\n", "reprojection error", answer.calibration.rms_px);
    text += fmt::format("  {:<22}{:.0f} % of the image\n", "seen in", 100.0 * answer.coverage.share);
    text += fmt::format("  {:<22}{:.1f} degrees at most between views\n", "tilt",
                        calib::widest_tilt_rad(answer.calibration) / deg);
    if (answer.calibration.unused > 0)
        text += fmt::format("  {:<22}{} tags that fit badly\n", "left out", answer.calibration.unused);
    if (!answer.no_noise.empty()) text += fmt::format("  noise not determined: {}\n", answer.no_noise);
    text += fmt::format("  {:<22}{}\n", "lens", name_of(answer.calibration.camera.distortion.model));
    for (const std::string& note : answer.notes) text += fmt::format("  note: {}\n", note);
    if (answer.shortcomings.empty()) return text + "good\n";
    for (const std::string& reason : answer.shortcomings)
        text += fmt::format("not good enough: {}\n", reason);
    return text;
}

std::string camera_report(const CameraAnswer& answer) {
    report::Page page;
    page.title = "Camera calibration";
    page.kind = "Camera calibration";
    page.headline = headline_of(answer);
    page.subline = fmt::format("{} views in {} images of {}; {}", answer.calibration.views.size(),
                               answer.images, answer.source, answer.target);
    page.mood = answer.shortcomings.empty() ? report::Mood::good : report::Mood::bad;
    page.figures = {{fmt::format("{:.3g} px", answer.calibration.rms_px), "reprojection error, r.m.s."},
                    {fmt::format("{:.0f} %", 100.0 * answer.coverage.share), "of the image seen"},
                    {fmt::format("{:.2g} %", 100.0 * answer.calibration.std_of(calib::focal) /
                                                 answer.calibration.camera.focal_px),
                     "standard error of the focal length"},
                    {fmt::format("{}", calib::different_views(answer.calibration)), "views that differ"}};
    if (!answer.shortcomings.empty()) {
        std::string reasons = "<ul>";
        for (const std::string& reason : answer.shortcomings)
            reasons += "<li>" + report::escaped(reason) + "</li>";
        page.body += report::section("verdict", "Why it is not good enough", reasons + "</ul>");
    }
    if (!answer.notes.empty()) {
        std::string notes = "<ul>";
        for (const std::string& note : answer.notes) notes += "<li>" + report::escaped(note) + "</li>";
        page.body += report::section("notes", "What would explain the corners better", notes + "</ul>");
    }
    page.body += report::section("values", "Values", lens_values_table(answer));
    page.body += report::section("coverage", "Where in the image the target was seen",
                                 coverage_svg(answer.calibration, answer.coverage));
    page.body += report::section("residuals", "What the calibration leaves",
                                 residual_field_svg(answer.calibration) + residual_chart(answer.calibration));
    page.body += report::section("views", "Views", views_table(answer.calibration));
    if (answer.noise) page.body += report::section("noise", "Noise", noise_section(*answer.noise));
    page.footer = fmt::format("fidservo {}", program_version());
    return report::render(page);
}

}  // namespace fidservo
