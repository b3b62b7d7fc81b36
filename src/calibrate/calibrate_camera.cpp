// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/calibrate_camera.h"

#include "calib/camera/other_explanations.h"
#include "calib/camera/photon_transfer.h"
#include "calib/camera/target_images.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/calibrate/camera_images.h"
#include "src/calibrate/camera_report.h"
#include "src/files/disk/durable_file.h"
#include "src/files/disk/output_paths.h"
#include "src/files/rig/camera_info.h"
#include "src/files/rig/rig_edit.h"
#include "src/files/rig/rig_file.h"
#include "src/process/exit_code.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

void demand_new_files(const CalibrateCameraOptions& options) {
    const std::array<std::pair<const char*, const fs::path*>, 3> files{
        {{"--camera-info", &options.camera_info},
         {"--write-rig", &options.write_rig},
         {"--report", &options.report}}};
    for (const auto& [option, file] : files) {
        std::error_code error;
        if (!file->empty() && fs::symlink_status(*file, error).type() != fs::file_type::not_found)
            throw InputError(
                fmt::format("{}: {}: exists already; give the name of a new file", option, file->string()));
        for (const auto& [other, same] : files)
            if (other != option && !file->empty() && file->lexically_normal() == same->lexically_normal())
                throw InputError(fmt::format("{}, {}: {}: are one file", option, other, file->string()));
    }
}

LensModel model_of(const CalibrateCameraOptions& options) {
    const auto model = std::ranges::find(lens_models, options.lens,
                                         [](LensModel each) { return std::string(name_of(each)); });
    if (model == lens_models.end())
        throw InputError(fmt::format("--lens: {}: allowed: {}, {}", options.lens, name_of(lens_models[0]),
                                     name_of(lens_models[1])));
    return *model;
}

CameraTarget target_of(const CalibrateCameraOptions& options, const Rig& rig) {
    if (!options.target_file.empty()) {
        if (!options.grid.empty() || options.tag_size_mm != 0.0 || options.tag_spacing != 0.0)
            throw InputError(
                "--target: says what --grid, --tag-size-mm and --tag-spacing would: give one of the two");
        return load_kalibr_target(options.target_file);
    }
    if (!options.grid.empty()) return april_grid(options.grid, options.tag_size_mm, options.tag_spacing);
    if (options.tag_size_mm != 0.0 || options.tag_spacing != 0.0)
        throw InputError("--tag-size-mm, --tag-spacing: are for --grid only");
    if (!rig.fiducials)
        throw InputError(fmt::format("{}: fiducials: missing, and no --grid or --target: what is the target?",
                                     options.rig_file.string()));
    return plate_target(*rig.fiducials);
}

/// Of a camera of which nothing is known, before a target that is printed and lit no better than others: what
/// the model of its picture misses is some per cent of the light.
constexpr vision::GreyNoise photograph_noise{1.0, 1.0, 0.05};

std::string names_of(const std::vector<fs::path>& inputs) {
    return inputs.size() == 1 ? inputs.front().string()
                              : fmt::format("{} and {} more", inputs.front().string(), inputs.size() - 1);
}

/// Frames at rest, given or found.
void measure_noise(const CalibrateCameraOptions& options, const CalibrationImages& images,
                   CameraAnswer& answer) {
    std::vector<std::vector<cv::Mat>> bursts = images.bursts;
    if (!options.noise_frames.empty()) bursts = {read_burst(options.noise_frames)};
    if (bursts.empty()) return;
    const Result<calib::PhotonTransfer> noise = calib::measure_noise(bursts);
    if (noise)
        answer.noise = *noise;
    else
        answer.no_noise = noise.error().text;
}

/// Scale stays as it was: distance and focal length change together; the mount is for `calibrate stage`.
void write_rig(const CalibrateCameraOptions& options, const CameraAnswer& answer,
               const CameraParameters& before) {
    const CameraGeometry& camera = answer.calibration.camera;
    RigEdit edit(options.rig_file);
    edit.set("camera.width_px", camera.width_px);
    edit.set("camera.height_px", camera.height_px);
    edit.set("camera.focal_px", camera.focal_px);
    edit.set("camera.focal_ratio", camera.focal_ratio);
    edit.set("camera.principal_point_px",
             std::array{camera.principal_point_px.x(), camera.principal_point_px.y()});
    if (camera.distortion.model != before.geometry.distortion.model)
        edit.set_name("camera.lens", name_of(camera.distortion.model));
    edit.set("camera.distortion", numbers_of(camera.distortion));
    edit.set("camera.distance_mm", before.geometry.distance_mm * camera.focal_px / before.geometry.focal_px);
    const auto error = [&](calib::LensParameter parameter) { return answer.calibration.std_of(parameter); };
    RigProvenance provenance{"camera", {answer.source}, {}, {{"corners_px", answer.calibration.rms_px}}};
    for (std::size_t k = 0; k < calib::lens_parameters; ++k)
        if (const auto parameter = static_cast<calib::LensParameter>(k);
            calib::belongs_to(camera.distortion.model, parameter))
            provenance.standard_errors.emplace_back(calib::name_of(parameter), error(parameter));
    if (answer.noise) {
        edit.set("camera.full_well_e", answer.noise->full_well_e);
        edit.set("camera.read_noise_e", answer.noise->read_noise_e);
        edit.set("camera.gain_spread", answer.noise->gain_spread);
        provenance.standard_errors.emplace_back("full_well_e", answer.noise->full_well_std_e);
        provenance.standard_errors.emplace_back("read_noise_e", answer.noise->read_noise_std_e);
        provenance.standard_errors.emplace_back("gain_spread", answer.noise->gain_spread_std);
    }
    edit.set_provenance(provenance);
    edit.save(options.write_rig);
    fmt::print("rig file: {}\n", options.write_rig.string());
}

}  // namespace

int calibrate_camera(const CalibrateCameraOptions& options) {
    demand_new_files(options);
    const LensModel model = model_of(options);
    const Rig rig = load_rig(options.rig_file);
    if (!options.write_rig.empty() && !rig.camera)
        throw InputError(fmt::format("{}: camera: missing: --write-rig changes one that is there",
                                     options.rig_file.string()));
    const CameraTarget target = target_of(options, rig);
    const CalibrationImages images = read_calibration_images(options.inputs, target);
    for (const std::string& note : images.notes) spdlog::info("{}", note);

    calib::ImageCalibrationOptions how;
    how.lens.width_px = images.width_px;
    how.lens.height_px = images.height_px;
    how.lens.model = model;
    how.lens.fit_focal_ratio = options.focal_ratio;
    const bool is_own_plate = rig.camera && target.is_rigs_plate;
    how.noise = is_own_plate ? vision::grey_noise(*rig.camera) : photograph_noise;
    Result<calib::CameraCalibration> calibration = calib::calibrate_camera(images.views, target.tags, how);
    if (!calibration) {
        fmt::print("not good enough: {}\n", calibration.error().text);
        return exit_answer_is_no;
    }
    calib::count_other_model(*calibration);
    CameraAnswer answer{.target = target.text,
                        .source = names_of(options.inputs),
                        .images = images.images,
                        .without_target = images.without_target,
                        .calibration = *calibration,
                        .coverage = calib::coverage_of(*calibration),
                        .shortcomings = calib::shortcomings(*calibration, options.limits, target.tags),
                        .notes = {},
                        .noise = {},
                        .no_noise = {}};
    if (answer.shortcomings.empty()) answer.notes = calib::notes_on(*calibration);
    measure_noise(options, images, answer);
    fmt::print("{}", describe(answer));
    if (!options.report.empty()) {
        write_or_throw(options.report, camera_report(answer));
        fmt::print("report: {}\n", options.report.string());
    }
    if (!answer.shortcomings.empty()) return exit_answer_is_no;
    if (!options.camera_info.empty()) {
        write_or_throw(options.camera_info, camera_info_text(camera_info_of(calibration->camera, rig.name)));
        fmt::print("camera info: {}\n", options.camera_info.string());
    }
    if (!options.write_rig.empty()) write_rig(options, answer, *rig.camera);
    return exit_done;
}

}  // namespace fidservo
