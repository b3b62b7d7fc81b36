// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/practice_detections.h"

#include "core/camera/camera_parameters.h"
#include "core/fiducial_parameters.h"

#include <algorithm>
#include <cmath>

namespace fidservo {

namespace {

/// Column or row of the grid nearest to a plate coordinate.
int nearest_index(double place_mm, double pitch_mm, int count) {
    if (count == 1) return 0;
    return std::clamp(static_cast<int>(std::lround(place_mm / pitch_mm)), 0, count - 1);
}

bool is_inside(const CameraGeometry& camera, const Eigen::Vector2d& point_px) {
    return point_px.x() >= -0.5 && point_px.y() >= -0.5 && point_px.x() < camera.width_px - 0.5 &&
           point_px.y() < camera.height_px - 0.5;
}

/// Nominal exposure per exposure.
double exposure_ratio(const CameraParameters& camera, const plant::CameraDeviation& deviation) {
    return camera.exposure_s / (camera.exposure_s + deviation.extra_exposure_s);
}

}  // namespace

PracticeDetector::PracticeDetector(const CameraParameters& camera, const plant::CameraDeviation& deviation,
                                   const FiducialParameters& fiducials, std::uint64_t seed)
    : camera_(camera),
      deviation_(deviation),
      actual_(plant::actual_camera(camera.geometry, deviation)),
      max_speed_mm_per_s_(camera.max_speed_mm_per_s),
      fiducials_(fiducials),
      noise_(seed, "corners") {
    if (deviation.extra_exposure_s > 0.0) max_speed_mm_per_s_ *= exposure_ratio(camera, deviation);
}

double PracticeDetector::reach_s() const {
    const double exposure_s =
        deviation_.extra_exposure_s > 0.0 ? camera_.exposure_s + deviation_.extra_exposure_s : 0.0;
    return 0.5 * (exposure_s + std::abs(deviation_.readout_s));
}

double PracticeDetector::seen_s_mm(const Path& s_mm, double after_s) const {
    if (deviation_.extra_exposure_s == 0.0) return s_mm(after_s);
    const auto mean_over = [&](double exposure_s) {
        constexpr int parts = 32;
        double sum = 0.0;
        for (int k = 0; k < parts; ++k) sum += s_mm(after_s + exposure_s * ((k + 0.5) / parts - 0.5));
        return sum / parts;
    };
    return s_mm(after_s) + mean_over(camera_.exposure_s + deviation_.extra_exposure_s) -
           mean_over(camera_.exposure_s);
}

/// The row decides when, and when decides the row: in a turned picture only, and the camera moves by far less
/// than a row while a row is read out, so that each round gains several digits.
Eigen::Vector2d PracticeDetector::corner_px(const Eigen::Vector2d& corner_mm, const Path& s_mm) const {
    Eigen::Vector2d corner = actual_.image_px(corner_mm, seen_s_mm(s_mm, 0.0));
    if (deviation_.readout_s == 0.0) return corner;
    constexpr int rounds = 4;
    for (int k = 0; k < rounds; ++k) {
        const double after_s = plant::row_delay_s(
            camera_.geometry, deviation_, std::clamp(corner.y(), 0.0, camera_.geometry.height_px - 1.0));
        corner = actual_.image_px(corner_mm, seen_s_mm(s_mm, after_s));
    }
    return corner;
}

std::optional<TagDetection> PracticeDetector::detect(TimeNs stamp_ns, double time_s, const Path& s_mm,
                                                     double speed_mm_per_s) {
    if (std::abs(speed_mm_per_s) > max_speed_mm_per_s_) return std::nullopt;
    if (plant::geometry_changes(deviation_))
        actual_ = plant::actual_camera(camera_.geometry, plant::deviation_at(deviation_, time_s, s_mm(0.0)));
    const Eigen::Vector2d middle_mm = actual_.plate_mm(camera_.geometry.principal_point_px, s_mm(0.0));
    const int column = nearest_index(middle_mm.x(), fiducials_.pitch_x_mm, fiducials_.columns);
    const int row = nearest_index(middle_mm.y(), fiducials_.pitch_y_mm, fiducials_.rows);
    const Eigen::Vector2d centre_mm(column * fiducials_.pitch_x_mm, row * fiducials_.pitch_y_mm);

    const Eigen::Vector2d lies_mm = centre_mm + plant::tag_offset_mm(deviation_, centre_mm);

    TagDetection detection;
    detection.time_ns = stamp_ns;
    detection.print = fiducials_.print;
    detection.tag_id = fiducials_.first_id + row * fiducials_.columns + column;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d ideal_px = corner_px(lies_mm + 0.5 * fiducials_.side_mm * tag_corners[k], s_mm);
        if (!is_inside(camera_.geometry, ideal_px)) return std::nullopt;
        const double noise_u = noise_.normal();
        detection.corners_px[k] =
            ideal_px + camera_.corner_noise_px * Eigen::Vector2d(noise_u, noise_.normal());
    }
    return detection;
}

}  // namespace fidservo
