// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The appearance of tags to a camera whose deviation is known.
#include "core/recording.h"
#include "plant/camera.h"
#include "plant/view/view_options.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

namespace fidservo::testing {

inline constexpr double looks_px_per_s = 375.0;

/// A tag that moves at constant speed along u for a second, 50 frames: its places and its appearance by the
/// formulas of gap/links/image_link.h, on the reference rig.
inline Recording looks_in_even_motion(const plant::CameraDeviation& truth,
                                      double speed_px_per_s = looks_px_per_s) {
    constexpr double frame_s = 0.02;
    const CameraParameters camera = *reference_rig().camera;
    Recording recording;
    recording.tick_s = 1e-3;
    for (int k = 0; k < 1000; ++k) recording.rows.push_back({.time_ns = nanoseconds(1e-3 * k)});
    for (int frame = 0; frame < 50; ++frame) {
        const double u_px = 200.0 + speed_px_per_s * frame_s * frame;
        TagDetection tag;
        tag.time_ns = nanoseconds(3e-3 + frame_s * frame);
        tag.tag_id = 4;
        for (std::size_t k = 0; k < 4; ++k) {
            tag.corners_px[k] = Eigen::Vector2d(u_px, 480.0) + 150.0 * tag_corners[k];
            tag.corners_px[k].x() +=
                speed_px_per_s * plant::row_delay_s(camera.geometry, truth, tag.corners_px[k].y());
        }
        recording.detections.push_back(tag);
        TagAppearance look;
        look.time_ns = tag.time_ns;
        look.tag_id = tag.tag_id;
        for (std::size_t k = 0; k < 4; ++k) {
            const double normal_u = k % 2 == 0 ? 0.0 : 1.0, outwards = k == 1 || k == 2 ? 1.0 : -1.0;
            TagSide& side = look.sides[k];
            side.normal = {normal_u, 1.0 - normal_u};
            const double way_px = speed_px_per_s * (camera.exposure_s + truth.extra_exposure_s) * normal_u;
            side.variance_px2 = std::pow(camera.blur_px, 2) + std::pow(truth.extra_blur_px, 2) +
                                (1.0 + way_px * way_px) / 12.0;
            side.variance_std_px2 = 0.01;
            side.strip_px = Eigen::Vector2d(u_px, 480.0) + 150.0 * outwards * side.normal;
            side.half_strip_px = {0.0, 0.0};
            const Eigen::Vector2d place((side.strip_px.x() - 639.5) / 639.5,
                                        (side.strip_px.y() - 479.5) / 479.5);
            plant::Light light;
            light.level = 0.7;  // any level
            light.gradient += truth.light_gradient;
            light.vignetting += truth.vignetting;
            side.white_grey = 230.0 * plant::brightness(light, place);
            side.white_std_grey = 0.1;
        }
        const double per_e = 255.0 / camera.full_well_e;
        const auto noise = [&](double grey) {
            return GreyNoiseSeen{
                grey,
                per_e * grey +
                    std::pow(per_e * std::hypot(camera.read_noise_e, truth.extra_read_noise_e), 2) +
                    std::pow(truth.gain_spread * grey, 2) + 1.0 / 12.0,
                0.02};
        };
        look.white = noise(160.0);
        look.black = noise(18.0);
        recording.appearances.push_back(look);
    }
    return recording;
}

}  // namespace fidservo::testing
