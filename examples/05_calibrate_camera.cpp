// SPDX-License-Identifier: GPL-3.0-or-later
// A camera's focal length and distortion from images of a grid of tags, seen from several sides. The images
// are the simulator's, so that the answer is known; vision::read_grey() reads those in files.
#include "calib/camera/target_images.h"
#include "plant/view/plate_view.h"
#include "vision/tags/tag_detector.h"

#include <cstdio>
#include <vector>

namespace {

using namespace fidservo;

const CameraParameters true_camera{.geometry = {.width_px = 1280,
                                                .height_px = 960,
                                                .focal_px = 1500.0,
                                                .principal_point_px = {650.0, 470.0},
                                                .distance_mm = 60.0},
                                   .exposure_s = 0.002,
                                   .full_well_e = 10000.0,
                                   .read_noise_e = 5.0,
                                   .blur_px = 0.8};

Plate tag_grid() {
    Plate grid;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 5; ++column)
            grid.tags.push_back({.id = 5 * row + column,
                                 .centre_mm = {8.0 * (column - 2), 8.0 * (row - 1.5)},
                                 .side_mm = 5.0});
    return grid;
}

}  // namespace

int main() {
    const Plate grid = tag_grid();
    vision::TagDetector detector;
    std::vector<calib::TargetImage> images;
    const std::vector<Eigen::Vector2d> tilts_rad{{0, 0},   {0.4, 0},  {-0.4, 0},
                                                 {0, 0.4}, {0, -0.4}, {0.3, 0.3}};
    for (const Eigen::Vector2d& tilt_rad : tilts_rad) {
        const plant::PlateView view(true_camera, grid, {}, {.tilt_rad = tilt_rad});
        const cv::Mat image = view.render(std::vector{0.0}, images.size());
        images.push_back({"view " + std::to_string(images.size()), image, detector.detect(image, 0)});
    }

    calib::ImageCalibrationOptions options;
    options.lens.width_px = true_camera.geometry.width_px;
    options.lens.height_px = true_camera.geometry.height_px;
    const auto found = calib::calibrate_camera(images, grid.tags, options);
    if (!found) return std::fprintf(stderr, "05_calibrate_camera: %s\n", found.error().text.c_str()), 1;
    std::printf("focal length %.3f +- %.3f px (true: %.1f)\n", found->camera.focal_px,
                found->std_of(calib::LensParameter::focal), true_camera.geometry.focal_px);
    std::printf("principal point %.3f, %.3f px (true: 650.0, 470.0)\n", found->camera.principal_point_px.x(),
                found->camera.principal_point_px.y());
    std::printf("%zu views, %.4f px r.m.s.\n", found->views.size(), found->rms_px);
}
