// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace fidservo::precision {
namespace {

constexpr double white_grey = 255.0;
constexpr float steps_per_level = 64.0F;

double variance_e2(const Sensor& sensor, double share) {
    const double electrons = std::max(0.0, share) * sensor.full_well_e;
    return electrons + sensor.read_noise_e * sensor.read_noise_e +
           std::pow(sensor.gain_spread * electrons, 2);
}

double response(const Sensor& sensor, double share) {
    return std::pow(std::clamp(share, 0.0, 1.0), 1.0 / sensor.gamma);
}

/// Four normal deviates of 64 random bits: the middles of 65,536 equally likely intervals, scaled to
/// variance 1. The largest is 4.2; what lies beyond has a probability of 3e-5.
class NormalQuantiles {
  public:
    NormalQuantiles() {
        constexpr std::size_t half = count / 2;
        double z = 0.0, squares = 0.0;
        for (std::size_t k = 0; k < half; ++k) {
            const double share = 0.5 + (static_cast<double>(k) + 0.5) / count;
            for (int step = 0; step < 3; ++step)
                z -= (0.5 * std::erfc(-z / std::numbers::sqrt2) - share) * std::sqrt(2.0 * std::numbers::pi) *
                     std::exp(0.5 * z * z);
            values_.at(half + k) = static_cast<float>(z);
            squares += z * z;
        }
        const float scale = static_cast<float>(1.0 / std::sqrt(squares / half));
        for (std::size_t k = 0; k < half; ++k) {
            values_.at(half + k) *= scale;
            values_.at(half - 1 - k) = -values_.at(half + k);
        }
    }

    float operator[](std::uint64_t sixteen_bits) const { return values_[sixteen_bits]; }

  private:
    static constexpr std::size_t count = 65536;
    std::array<float, count> values_;
};

}  // namespace

double grey_of(const Sensor& sensor, double share) {
    return white_grey * response(sensor, share);
}

double grey_variance(const Sensor& sensor, double share) {
    const double grey_per_e = white_grey / sensor.full_well_e;
    if (sensor.noise_after_gamma)
        return variance_e2(sensor, response(sensor, share)) * grey_per_e * grey_per_e + 1.0 / 12.0;
    const double slope = std::pow(std::max(share, 1e-3), 1.0 / sensor.gamma - 1.0) / sensor.gamma;
    return variance_e2(sensor, share) * std::pow(grey_per_e * slope, 2) + 1.0 / 12.0;
}

FrameSource::FrameSource(const Sensor& sensor, const cv::Mat1d& mean_picture)
    : mean_grey_(mean_picture.size()), sigma_grey_(mean_picture.size()) {
    for (int v = 0; v < mean_picture.rows; ++v)
        for (int u = 0; u < mean_picture.cols; ++u) {
            const double share =
                sensor.noise_after_gamma ? response(sensor, mean_picture(v, u)) : mean_picture(v, u);
            mean_grey_(v, u) = static_cast<float>(white_grey * share);
            sigma_grey_(v, u) =
                static_cast<float>(white_grey / sensor.full_well_e * std::sqrt(variance_e2(sensor, share)));
        }
    if (sensor.gamma == 1.0 || sensor.noise_after_gamma) return;
    for (int k = 0; k <= static_cast<int>(white_grey * steps_per_level); ++k)
        levels_.push_back(static_cast<unsigned char>(
            std::lround(grey_of(sensor, k / (white_grey * static_cast<double>(steps_per_level))))));
}

unsigned char FrameSource::level_of(float grey) const {
    const float clipped = std::clamp(grey, 0.0F, static_cast<float>(white_grey));
    if (levels_.empty()) return static_cast<unsigned char>(clipped + 0.5F);
    return levels_[static_cast<std::size_t>(clipped * steps_per_level + 0.5F)];
}

void FrameSource::draw(NoiseStream& noise, cv::Mat1b& frame, const cv::Rect& region) const {
    static const NormalQuantiles quantiles;
    const bool whole = frame.empty();
    if (whole) frame.create(mean_grey_.size());
    const cv::Rect drawn = whole ? cv::Rect({}, frame.size()) : region & cv::Rect({}, frame.size());
    for (int v = drawn.y; v < drawn.br().y; ++v) {
        const float* mean = mean_grey_[v];
        const float* sigma = sigma_grey_[v];
        unsigned char* grey = frame[v];
        std::uint64_t bits = 0;
        for (int u = drawn.x; u < drawn.br().x; ++u, bits >>= 16) {
            if ((u - drawn.x) % 4 == 0) bits = noise.bits();
            grey[u] = level_of(mean[u] + sigma[u] * quantiles[bits & 0xffffu]);
        }
    }
}

}  // namespace fidservo::precision
