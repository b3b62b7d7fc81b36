// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/pixel_map.h"

#include "core/camera/camera_slopes.h"

#include <algorithm>

namespace fidservo::plant::view {
namespace {

/// x and y per z of a ray from the camera. The flat picture ends at 87 degrees from the plate's normal; what
/// a fisheye shows beyond, or where it shows nothing, is taken from its end.
Eigen::Vector2d slope_of(const Eigen::Vector3d& ray) {
    constexpr double steepest = 20.0;
    const double aside = ray.head<2>().norm();
    if (ray.z() * steepest >= aside) return ray.head<2>() / ray.z();
    if (aside > 0.0) return steepest / aside * ray.head<2>();
    return {steepest, 0.0};
}

}  // namespace

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
            const Eigen::Vector3d ray =
                plate_from_camera * ray_of(camera.distortion, pictured_at(camera, {u, v}));
            const Eigen::Vector2d seen = flat.place_of_ray(slope_of(ray));
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
