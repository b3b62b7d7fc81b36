// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/vision/rendered_tag.h"

#include "core/random.h"
#include "tests/tag_precision/tag_scene.h"

#include <cmath>

#include <opencv2/core.hpp>

namespace fidservo::vision::testing {
namespace {

precision::TagScene scene_of(const RenderedTag& tag, const Rendering& how) {
    precision::TagScene scene;
    scene.tag_id = tag.id;
    scene.centre_px = tag.centre_px;
    scene.side_px = tag.side_px;
    scene.angle_rad = tag.angle_rad;
    scene.camera.width_px = how.size_px.width;
    scene.camera.height_px = how.size_px.height;
    scene.blur.sigma_px = how.blur_px;
    return scene;
}

}  // namespace

std::array<Eigen::Vector2d, 4> corners_of(const RenderedTag& tag) {
    return precision::corners_of(scene_of(tag, {}));
}

cv::Mat render(const std::vector<RenderedTag>& tags, const Rendering& how) {
    cv::Mat1d grey(how.size_px, tags.empty() ? 229.0 : tags.front().white);
    for (const RenderedTag& tag : tags)
        grey += cv::Mat1d((tag.black - tag.white) * precision::ink_picture(scene_of(tag, how)));
    NoiseStream noise(how.seed, "rendered_tag");
    cv::Mat1b image(how.size_px);
    const double electrons_per_level = how.full_well_e / 255.0;
    for (int v = 0; v < grey.rows; ++v)
        for (int u = 0; u < grey.cols; ++u) {
            double electrons = grey(v, u) * electrons_per_level;
            if (how.noise)
                electrons += noise.normal() * std::sqrt(electrons + how.read_noise_e * how.read_noise_e);
            image(v, u) = cv::saturate_cast<unsigned char>(electrons / electrons_per_level);
        }
    return image;
}

}  // namespace fidservo::vision::testing
