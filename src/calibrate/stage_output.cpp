// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "src/calibrate/calibrate_stage.h"
#include "src/calibrate/stage_values.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/rig_edit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo {

namespace {

nlohmann::json finite_or_null(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// Mean of the four corners and its standard deviations.
std::pair<Eigen::Vector2d, Eigen::Vector2d> middle_of(const calib::SeenTag& tag) {
    Eigen::Matrix<double, 2, 8> mean;
    for (int k = 0; k < 4; ++k) mean.middleCols<2>(2 * k) = 0.25 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : tag.corners_px) middle += 0.25 * corner;
    return {middle, (mean * tag.covariance_px2 * mean.transpose()).diagonal().cwiseSqrt()};
}

std::string stands_csv(const StageCalibration& calibration) {
    std::string csv =
        "stand,move,time [s],encoder [count],hall [adc],tag,u [px],v [px],u std [px],v std [px],s [mm]\n";
    std::size_t stand = 0;
    for (const StageShot& shot : calibration.shots) {
        const double s_mm = calib::check_view(calibration.numbers.map, shot.tags).s_mm;
        for (const calib::SeenTag& tag : shot.tags) {
            const auto [middle, std] = middle_of(tag);
            csv += fmt::format("{},{},{:.4f},{},{:.4f},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f}\n", stand,
                               name_of(shot.move), shot.time_s, shot.count, shot.hall_mean(), tag.nominal.id,
                               middle.x(), middle.y(), std.x(), std.y(), s_mm);
        }
        ++stand;
    }
    return csv;
}

}  // namespace

bool StageCalibration::passed() const {
    return std::ranges::all_of(tests, &FreshTest::passed);
}

std::string describe(const Rig& rig, const StageCalibration& calibration) {
    std::string text;
    for (const StageValue& value : stage_values(rig, calibration.numbers))
        text += fmt::format("  {:<27} {:>26} {:<9}{}\n", value.key, with_std(value), value.unit,
                            value.in_rig_file ? fmt::format(" rig file: {:.9g}", value.file) : "");
    for (const FreshTest& test : calibration.tests)
        text += fmt::format(
            "  fresh moves, {}: {:.4g} {} r.m.s. (promised {:.4g}), worst {:.4g} (allowed "
            "{:.4g}): {}\n",
            test.what, test.rms, test.unit, test.promised_rms, test.worst, test.allowed_worst,
            test.passed ? "passed" : "failed");
    for (const std::string& note : stage_notes(calibration.numbers)) text += fmt::format("  {}\n", note);
    return text;
}

std::string describe(const std::vector<calib::DriftVerdict>& verdicts) {
    constexpr const char* row = "{:<29} {:>12} {:>12} {:>9}  {}\n";
    std::string text = fmt::format(row, "quantity", "expected", "measured", "std", "verdict");
    for (const calib::DriftVerdict& verdict : verdicts) {
        const calib::Expectation& of = verdict.of;
        text += fmt::format(row, of.unit.empty() ? of.quantity : fmt::format("{} [{}]", of.quantity, of.unit),
                            fmt::format("{:.7g}", of.expected), fmt::format("{:.7g}", of.measured),
                            fmt::format("{:.2g}", of.std), verdict.drifted ? "drifted" : "ok");
    }
    return text;
}

void write_stage_calibration(const std::filesystem::path& folder, const Rig& rig,
                             const StageCalibration& calibration) {
    nlohmann::ordered_json json{
        {"format", "fidservo-stage-calibration/1"},  {"rig", rig.name},
        {"values", nlohmann::json::array()},         {"tests", nlohmann::json::array()},
        {"notes", stage_notes(calibration.numbers)}, {"passed", calibration.passed()}};
    for (const StageValue& value : stage_values(rig, calibration.numbers))
        json["values"].push_back({{"key", value.key},
                                  {"unit", value.unit},
                                  {"value", finite_or_null(value.value)},
                                  {"std", finite_or_null(value.std)}});
    for (const FreshTest& test : calibration.tests)
        json["tests"].push_back({{"what", test.what},
                                 {"unit", test.unit},
                                 {"errors", test.errors},
                                 {"rms", finite_or_null(test.rms)},
                                 {"promised_rms", finite_or_null(test.promised_rms)},
                                 {"worst", finite_or_null(test.worst)},
                                 {"allowed_worst", finite_or_null(test.allowed_worst)},
                                 {"passed", test.passed}});
    write_or_throw(folder / "stage.json", json.dump(2) + '\n');
    write_or_throw(folder / "stands.csv", stands_csv(calibration));
    write_or_throw(folder / "report.html", stage_report(rig, calibration));
}

void write_stage_check(const std::filesystem::path& folder,
                       const std::vector<calib::DriftVerdict>& verdicts) {
    nlohmann::ordered_json json{{"format", "fidservo-stage-check/1"},
                                {"healthy", std::ranges::none_of(verdicts, &calib::DriftVerdict::drifted)},
                                {"quantities", nlohmann::json::array()}};
    for (const calib::DriftVerdict& verdict : verdicts)
        json["quantities"].push_back({{"quantity", verdict.of.quantity},
                                      {"unit", verdict.of.unit},
                                      {"expected", finite_or_null(verdict.of.expected)},
                                      {"measured", finite_or_null(verdict.of.measured)},
                                      {"std", finite_or_null(verdict.of.std)},
                                      {"bound", finite_or_null(verdict.bound)},
                                      {"verdict", verdict.drifted ? "drifted" : "ok"}});
    write_or_throw(folder / "check.json", json.dump(2) + '\n');
}

void write_stage_rig(const std::filesystem::path& file, const std::filesystem::path& source_rig_file,
                     const Rig& rig, const StageCalibration& calibration) {
    const StageNumbers& numbers = calibration.numbers;
    const CameraGeometry& camera = numbers.map.camera;
    const HallParameters& hall = numbers.hall.hall;
    RigEdit edit(source_rig_file);
    edit.set("camera.distance_mm", camera.distance_mm);
    edit.set("camera.distortion", numbers_of(camera.distortion));
    edit.set("camera.rotation_rad", camera.rotation_rad);
    edit.set("camera.tilt_rad", std::array{camera.tilt_rad.x(), camera.tilt_rad.y()});
    edit.set("camera.axis_rad", std::array{camera.axis_rad.x(), camera.axis_rad.y()});
    edit.set("camera.geometry_covariance", lower_triangle(numbers.map.camera_covariance));
    edit.set("macro.encoder_resolution_mm", numbers.encoder.resolution_mm);
    edit.set("micro.hall.mid_V", hall.mid_V);
    edit.set("micro.hall.span_V", hall.span_V);
    edit.set("micro.hall.centre_mm", hall.centre_mm);
    edit.set("micro.hall.cubic", hall.cubic);
    RigProvenance provenance{"stage", {"stage calibration"}, {}, {}};
    for (const StageValue& value : stage_values(rig, numbers))
        provenance.standard_errors.emplace_back(value.key, value.std);
    provenance.residuals = {{"corners_px", numbers.map.residual_rms_px},
                            {"hall_adc", numbers.hall.residual_lsb},
                            {"platform_mm", numbers.platform_error_mm}};
    edit.set_provenance(provenance);
    edit.save(file);
}

}  // namespace fidservo
