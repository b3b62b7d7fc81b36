#include "tests/vision/rendered_tag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

#include "core/random.h"

#include <opencv2/imgproc.hpp>

namespace fidservo::vision::testing {
namespace {

constexpr int cells = 8;

/// The tag's 8 x 8 cells as the library draws them, 1 is white; its own picture has a white rim.
cv::Mat1f pattern_of(int id) {
    apriltag_family_t* family = tag36h11_create();
    image_u8_t* drawn = apriltag_to_image(family, id);
    cv::Mat1f pattern(cells, cells);
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column)
            pattern(row, column) = drawn->buf[(row + 1) * drawn->stride + column + 1] > 127 ? 1.0F : 0.0F;
    free(drawn->buf);
    free(drawn);
    tag36h11_destroy(family);
    return pattern;
}

/// Integral of the normal distribution function with standard deviation `blur`, from minus infinity to x.
double ramp(double x, double blur) {
    if (blur <= 0) return std::max(x, 0.0);
    const double z = x / blur;
    return x * 0.5 * std::erfc(-z / std::numbers::sqrt2) +
           blur * std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

/// How much of a blurred interval falls into the pixel at u: optics first, then the pixel's area.
double share(int u, double low, double high, double blur) {
    return ramp(u + 0.5 - low, blur) - ramp(u - 0.5 - low, blur) - ramp(u + 0.5 - high, blur) +
           ramp(u - 0.5 - high, blur);
}

void draw_upright(const RenderedTag& tag, const cv::Mat1f& pattern, double blur_px, cv::Mat1d& grey) {
    const double cell = tag.side_px / cells;
    const auto shares = [&](int pixels, double centre) {
        cv::Mat1d table(pixels, cells);
        for (int k = 0; k < cells; ++k)
            for (int u = 0; u < pixels; ++u) {
                const double low = centre + (k - cells / 2) * cell;
                table(u, k) = share(u, low, low + cell, blur_px);
            }
        return table;
    };
    const cv::Mat1d by_column = shares(grey.cols, tag.centre_px.x());
    const cv::Mat1d by_row = shares(grey.rows, tag.centre_px.y());
    cv::Mat1d ink;
    cv::Mat1f(1.0F - pattern).convertTo(ink, CV_64F);
    grey += (tag.black - tag.white) * cv::Mat1d(by_row * ink * by_column.t());
}

/// On a grid four times as fine, with 4 x 4 samples of its own; blurred there, then averaged over pixels.
void draw_turned(const RenderedTag& tag, const cv::Mat1f& pattern, double blur_px, cv::Mat1d& grey) {
    constexpr int fine = 4;
    constexpr int samples = 4;
    const double cell = tag.side_px / cells;
    const double c = std::cos(tag.angle_rad);
    const double s = std::sin(tag.angle_rad);
    cv::Mat1d ink(grey.size() * fine, 0.0);
    for (int v = 0; v < ink.rows; ++v)
        for (int u = 0; u < ink.cols; ++u) {
            const double u_px = (u + 0.5) / fine - 0.5 - tag.centre_px.x();
            const double v_px = (v + 0.5) / fine - 0.5 - tag.centre_px.y();
            if (std::hypot(u_px, v_px) > 0.75 * tag.side_px) continue;
            int black = 0;
            for (int dy = 0; dy < samples; ++dy)
                for (int dx = 0; dx < samples; ++dx) {
                    const double x = u_px + ((dx + 0.5) / samples - 0.5) / fine;
                    const double y = v_px + ((dy + 0.5) / samples - 0.5) / fine;
                    const int column = static_cast<int>(std::floor((c * x + s * y) / cell)) + cells / 2;
                    const int row = static_cast<int>(std::floor((c * y - s * x) / cell)) + cells / 2;
                    const bool inside = column >= 0 && column < cells && row >= 0 && row < cells;
                    black += inside && pattern(row, column) == 0.0F ? 1 : 0;
                }
            ink(v, u) = static_cast<double>(black) / (samples * samples);
        }
    if (blur_px > 0) cv::GaussianBlur(ink, ink, {}, fine * blur_px);
    cv::Mat1d coarse;
    cv::resize(ink, coarse, grey.size(), 0, 0, cv::INTER_AREA);
    grey += (tag.black - tag.white) * coarse;
}

}  // namespace

std::array<Eigen::Vector2d, 4> corners_of(const RenderedTag& tag) {
    const double h = tag.side_px / 2;
    const Eigen::Vector2d right = h * Eigen::Vector2d(std::cos(tag.angle_rad), std::sin(tag.angle_rad));
    const Eigen::Vector2d down(-right.y(), right.x());
    return {tag.centre_px - right + down, tag.centre_px + right + down, tag.centre_px + right - down,
            tag.centre_px - right - down};
}

cv::Mat render(const std::vector<RenderedTag>& tags, const Rendering& how) {
    cv::Mat1d grey(how.size_px, tags.empty() ? 229.0 : tags.front().white);
    for (const RenderedTag& tag : tags) {
        const cv::Mat1f pattern = pattern_of(tag.id);
        if (tag.angle_rad == 0.0)
            draw_upright(tag, pattern, how.blur_px, grey);
        else
            draw_turned(tag, pattern, how.blur_px, grey);
    }
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
