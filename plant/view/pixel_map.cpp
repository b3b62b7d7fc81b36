#include "plant/view/pixel_map.h"

namespace fidservo::plant::view {

PixelMap::PixelMap(const CameraOptics& optics, const ImageMap& flat) : width_(optics.nominal.width_px) {
    if (!optics.warps) return;
    const int height = optics.nominal.height_px;
    offsets_px_.reserve(static_cast<std::size_t>(width_) * height);
    for (int v = 0; v < height; ++v)
        for (int u = 0; u < width_; ++u) {
            const Eigen::Vector2d pixel(u, v);
            const Eigen::Vector2d seen = flat.place(back_project(optics, pixel, 0.0), 0.0);
            offsets_px_.emplace_back((seen - pixel).cast<float>());
        }
}

}  // namespace fidservo::plant::view
