// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/vision/quick_tag.h"

#include <cmath>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision::testing {

using Cells = std::array<std::array<bool, 8>, 8>;

Cells cells_of(int tag_id) {
    apriltag_family_t* family = tag36h11_create();
    image_u8_t* drawn = apriltag_to_image(family, tag_id);
    Cells cells{};
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column)
            cells[row][column] = drawn->buf[(row + 1) * drawn->stride + column + 1] > 127;
    free(drawn->buf);
    free(drawn);
    tag36h11_destroy(family);
    return cells;
}

Cells turned(const Cells& cells) {
    Cells out{};
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column) out[column][7 - row] = cells[row][column];
    return out;
}

std::array<Eigen::Vector2d, 4> corners_of(const QuickTag& tag) {
    const Eigen::Vector2d right =
        0.5 * tag.side_px * Eigen::Vector2d(std::cos(tag.angle_rad), std::sin(tag.angle_rad));
    const Eigen::Vector2d down(-right.y(), right.x());
    return {tag.centre_px - right + down, tag.centre_px + right + down, tag.centre_px + right - down,
            tag.centre_px - right - down};
}

cv::Mat draw(const std::vector<QuickTag>& tags, const QuickPicture& how) {
    cv::Mat1f grey(how.size_px, static_cast<float>(how.paper));
    for (const QuickTag& tag : tags) {
        const double reach = 0.5 * tag.side_px * std::sqrt(2.0) + 1.0;
        const double per_cell = 8.0 / tag.side_px;
        const double c = std::cos(tag.angle_rad) * per_cell, s = std::sin(tag.angle_rad) * per_cell;
        const int top = std::max(0, static_cast<int>(tag.centre_px.y() - reach));
        const int bottom = std::min(grey.rows - 1, static_cast<int>(tag.centre_px.y() + reach));
        const int left = std::max(0, static_cast<int>(tag.centre_px.x() - reach));
        const int right = std::min(grey.cols - 1, static_cast<int>(tag.centre_px.x() + reach));
        for (int v = top; v <= bottom; ++v)
            for (int u = left; u <= right; ++u) {
                double ink = 0.0;
                for (const double dv : {-0.25, 0.25})
                    for (const double du : {-0.25, 0.25}) {
                        const double x = u + du - tag.centre_px.x(), y = v + dv - tag.centre_px.y();
                        const double column = c * x + s * y + 4.0, row = c * y - s * x + 4.0;
                        if (column < 0 || row < 0 || column >= 8 || row >= 8) continue;
                        if (!tag.white[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)])
                            ink += 0.25;
                    }
                grey(v, u) += static_cast<float>(ink * (tag.black - tag.paper));
            }
    }
    cv::GaussianBlur(grey, grey, {}, 0.7);
    if (how.motion_blur_px > 1) cv::blur(grey, grey, {how.motion_blur_px, 1});
    cv::RNG random(how.seed);
    cv::Mat1f noise(how.size_px);
    random.fill(noise, cv::RNG::NORMAL, 0.0, how.noise_grey);
    grey += noise;
    cv::Mat image;
    grey.convertTo(image, CV_8U);
    return image;
}

}  // namespace fidservo::vision::testing
