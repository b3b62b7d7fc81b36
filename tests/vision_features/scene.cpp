// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/vision_features/scene.h"

#include "plant/view/plate_view.h"

#include <array>

namespace fidservo::vision::testing {

namespace {

RestImage render(const Scene& scene) {
    const plant::PlateView view(scene.camera, scene.plate, scene.view);
    const std::array s_mm{scene.s_mm};
    return {view.render(s_mm, 0), scene.camera, {scene.s_mm, 0.0}, {0.0, 0.0}};
}

}  // namespace

Scene scene_of(int width_px, int height_px) {
    constexpr double rig_width_px = 1280.0;
    const Eigen::Vector2d middle_px((width_px - 1) / 2.0, (height_px - 1) / 2.0);
    const CameraGeometry geometry{width_px, height_px, 5000.0, middle_px, 20.0};
    Scene scene{.plate = {},
                .camera = {.geometry = geometry,
                           .frame_rate_hz = 50.0,
                           .exposure_s = 0.002,
                           .full_well_e = 10000.0,
                           .read_noise_e = 5.0,
                           .blur_px = 0.8,
                           .latency_s = 0.03,
                           .corner_noise_px = 0.02,
                           .max_speed_mm_per_s = 20.0},
                .s_mm = 100.0,
                .view = {}};
    const double part = width_px / rig_width_px;
    scene.view.light = {1.0, Eigen::Vector2d(0.08, -0.06) * part, 0.06 * part * part};
    return scene;
}

RestImage take(Scene scene, std::uint64_t seed) {
    scene.view.seed = seed;
    return render(scene);
}

RestImage draw(Scene scene) {
    scene.view.noise = false;
    return render(scene);
}

}  // namespace fidservo::vision::testing
