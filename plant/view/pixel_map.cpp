#include "plant/view/pixel_map.h"

#include "core/camera_slopes.h"

#include <algorithm>

namespace fidservo::plant::view {

PixelMap::PixelMap(const CameraGeometry& camera, const ImageMap& flat) : width_(camera.width_px) {
    if (flat.is_image()) {
        view_ = {Eigen::Vector2d::Zero(), Eigen::Vector2d(camera.width_px - 1, camera.height_px - 1)};
        return;
    }
    const std::size_t pixels = static_cast<std::size_t>(camera.width_px) * camera.height_px;
    offset_u_px_.reserve(pixels);
    offset_v_px_.reserve(pixels);
    rows_.reserve(camera.height_px);
    const Eigen::Matrix3d plate_from_camera = camera_from_plate(camera).transpose();
    for (int v = 0; v < camera.height_px; ++v) {
        Span& row = rows_.emplace_back(Span{1e9, -1e9});
        for (int u = 0; u < width_; ++u) {
            const Eigen::Vector2d ideal = ideal_point(camera, {u, v});
            const Eigen::Vector3d ray = plate_from_camera * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
            const Eigen::Vector2d seen = flat.place_of_ray(ray.head<2>() / ray.z());
            offset_u_px_.push_back(static_cast<float>(seen.x() - u));
            offset_v_px_.push_back(static_cast<float>(seen.y() - v));
            row = {std::min(row.low_px, seen.y()), std::max(row.high_px, seen.y())};
            view_.extend(seen);
        }
    }
}

void PixelMap::places(int v, std::span<double> flat_u_px, std::span<double> flat_v_px) const {
    if (is_identity()) {
        for (int u = 0; u < width_; ++u) flat_u_px[u] = u;
        std::fill(flat_v_px.begin(), flat_v_px.end(), v);
        return;
    }
    const float* const offset_u = offset_u_px_.data() + static_cast<std::size_t>(v) * width_;
    const float* const offset_v = offset_v_px_.data() + static_cast<std::size_t>(v) * width_;
    for (int u = 0; u < width_; ++u) {
        flat_u_px[u] = u + static_cast<double>(offset_u[u]);
        flat_v_px[u] = v + static_cast<double>(offset_v[u]);
    }
}

PixelMap::Span PixelMap::rows_of(int v) const {
    if (is_identity()) return {static_cast<double>(v), static_cast<double>(v)};
    return rows_[v];
}

}  // namespace fidservo::plant::view
