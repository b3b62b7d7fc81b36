// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/camera_view.h"

#include "core/fiducial_parameters.h"

#include <cmath>
#include <limits>

namespace fidservo::reference {

namespace {

constexpr double first_frame_s = 3.3e-3;

double camera_clock_s(const CameraModel& model, std::int64_t frame) {
    return first_frame_s + static_cast<double>(frame) / model.camera.frame_rate_hz;
}

bool is_in_image(const CameraGeometry& image, const Eigen::Vector2d& point_px) {
    const Eigen::Vector2d from_edge = point_px.array() + 0.5;
    return from_edge.minCoeff() >= 0.0 && from_edge.x() < image.width_px && from_edge.y() < image.height_px;
}

/// Ray from the camera to a plate point before lens distortion: x/z and y/z, with z along the optical axis.
Eigen::Vector2d direction_of(const CameraModel& model, const Eigen::Vector2d& plate_mm, double s_mm) {
    const CameraDepartures& askew = model.departures;
    const Eigen::Vector2d from_s_mm(plate_mm.x() - s_mm, plate_mm.y());
    const Eigen::Vector2d along(std::cos(askew.tilt_axis_rad), std::sin(askew.tilt_axis_rad));
    const Eigen::Vector2d across(along.y(), -along.x());
    const double c = std::cos(askew.tilt_rad), s = std::sin(askew.tilt_rad);
    const double distance_mm = model.camera.geometry.distance_mm;
    const double b_mm = across.dot(from_s_mm), h_mm = askew.tilt_height * distance_mm;
    const double depth_mm = distance_mm + s * b_mm - h_mm * (1.0 - c);
    return (along.dot(from_s_mm) * along + (c * b_mm - s * h_mm) * across) / depth_mm;
}

/// Whether r (1 + k1 r^2) / (1 - k r^2) still grows there. Beyond, the formula of a barrel folds what is far
/// outside back into the image; no lens does.
bool lens_reaches(const CameraModel& model, const Eigen::Vector2d& direction) {
    const double square = direction.squaredNorm();
    return 1.0 + 3.0 * model.departures.distortion * square > 0.0 &&
           1.0 - std::abs(model.departures.division) * square > 0.0;
}

}  // namespace

Eigen::Vector2d image_of(const CameraModel& model, const Eigen::Vector2d& plate_mm, double s_mm) {
    const CameraGeometry& geometry = model.camera.geometry;
    const CameraDepartures& askew = model.departures;
    const Eigen::Vector2d straight = direction_of(model, plate_mm, s_mm);
    const double c = std::cos(askew.rotation_rad), s = std::sin(askew.rotation_rad);
    const Eigen::Vector2d turned(c * straight.x() - s * straight.y(), s * straight.x() + c * straight.y());
    const double bulge =
        (1.0 + askew.distortion * straight.squaredNorm()) / (1.0 - askew.division * straight.squaredNorm());
    const Eigen::Vector2d pixels(turned.x(), askew.aspect * turned.y());
    return geometry.principal_point_px + askew.scale * geometry.focal_px * bulge * pixels;
}

std::optional<TagDetection> see(const CameraModel& model, double s_mm, double speed_mm_per_s,
                                NoiseStream& noise) {
    if (std::abs(speed_mm_per_s) > model.camera.max_speed_mm_per_s) return std::nullopt;
    const CameraGeometry& geometry = model.camera.geometry;
    const Eigen::Vector2d image_centre_px(0.5 * (geometry.width_px - 1), 0.5 * (geometry.height_px - 1));
    const FiducialParameters& grid = model.fiducials;
    double nearest_px = std::numeric_limits<double>::infinity();
    TagDetection seen;
    Eigen::Vector2d tag_mm(0.0, 0.0);
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const Eigen::Vector2d centre_mm(grid.pitch_x_mm * column, grid.pitch_y_mm * row);
            if (!lens_reaches(model, direction_of(model, centre_mm, s_mm))) continue;
            const double away_px = (image_of(model, centre_mm, s_mm) - image_centre_px).norm();
            if (away_px >= nearest_px) continue;
            nearest_px = away_px;
            tag_mm = centre_mm;
            seen.tag_id = grid.first_id + row * grid.columns + column;
        }
    }
    const double half_mm = 0.5 * grid.side_mm;
    const std::array<Eigen::Vector2d, 4> corners_mm{
        tag_mm + Eigen::Vector2d(-half_mm, half_mm), tag_mm + Eigen::Vector2d(half_mm, half_mm),
        tag_mm + Eigen::Vector2d(half_mm, -half_mm), tag_mm + Eigen::Vector2d(-half_mm, -half_mm)};
    for (std::size_t i = 0; i < corners_mm.size(); ++i) {
        seen.corners_px[i] = image_of(model, corners_mm[i], s_mm);
        if (!is_in_image(geometry, seen.corners_px[i])) return std::nullopt;
        seen.corners_px[i].x() += model.camera.corner_noise_px * noise.normal();
        seen.corners_px[i].y() += model.camera.corner_noise_px * noise.normal();
    }
    return seen;
}

double exposure_s(const CameraModel& model, std::int64_t frame) {
    return camera_clock_s(model, frame) / (1.0 + model.departures.clock_skew);
}

TimeNs stamp_ns(const CameraModel& model, std::int64_t frame) {
    return nanoseconds(camera_clock_s(model, frame) + model.departures.latency_s);
}

}  // namespace fidservo::reference
