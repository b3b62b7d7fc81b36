#include "src/simulation/practice_detections.h"

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

}  // namespace

PracticeDetector::PracticeDetector(const CameraParameters& camera, const FiducialParameters& fiducials,
                                   std::uint64_t seed)
    : camera_(camera), fiducials_(fiducials), noise_(seed, "corners") {}

std::optional<TagDetection> PracticeDetector::detect(TimeNs time_ns, double s_mm, double speed_mm_per_s) {
    if (std::abs(speed_mm_per_s) > camera_.max_speed_mm_per_s) return std::nullopt;
    const int column = nearest_index(s_mm, fiducials_.pitch_x_mm, fiducials_.columns);
    const int row = nearest_index(0.0, fiducials_.pitch_y_mm, fiducials_.rows);
    const Eigen::Vector2d centre_mm(column * fiducials_.pitch_x_mm, row * fiducials_.pitch_y_mm);

    TagDetection detection;
    detection.time_ns = time_ns;
    detection.tag_id = fiducials_.first_id + row * fiducials_.columns + column;
    const std::array<Eigen::Vector2d, 4> corner_signs{{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d corner_mm = centre_mm + 0.5 * fiducials_.side_mm * corner_signs[k];
        const Eigen::Vector2d ideal_px = project(camera_.geometry, corner_mm, s_mm);
        if (!is_inside(camera_.geometry, ideal_px)) return std::nullopt;
        const double noise_u = noise_.normal();
        detection.corners_px[k] =
            ideal_px + camera_.corner_noise_px * Eigen::Vector2d(noise_u, noise_.normal());
    }
    return detection;
}

}  // namespace fidservo
