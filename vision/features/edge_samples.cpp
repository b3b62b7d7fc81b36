// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/edge_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fidservo::vision {

namespace {

/// The pixels within `reach_px` of a box, inside the image.
cv::Rect pixels_around(const cv::Mat& grey, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                       double reach_px) {
    const cv::Point first(static_cast<int>(std::floor(low.x() - reach_px)),
                          static_cast<int>(std::floor(low.y() - reach_px)));
    const cv::Point last(static_cast<int>(std::ceil(high.x() + reach_px)),
                         static_cast<int>(std::ceil(high.y() + reach_px)));
    return cv::Rect(first, last + cv::Point(1, 1)) & cv::Rect(0, 0, grey.cols, grey.rows);
}

}  // namespace

std::vector<EdgeSamples> samples_of_ring(const cv::Mat& grey, const Eigen::Vector2d& centre_px,
                                         double radius_px, const Reach& reach, int sectors) {
    std::vector<EdgeSamples> sections(sectors);
    const double outer = radius_px + reach.out_px;
    const double inner = std::max(0.0, radius_px - reach.in_px);
    const double sectors_per_rad = sectors / (2.0 * std::numbers::pi);
    const cv::Rect box = pixels_around(grey, centre_px, centre_px, outer);
    for (int v = box.y; v < box.y + box.height; ++v) {
        const auto* row = grey.ptr<unsigned char>(v);
        const double dy = v - centre_px.y();
        for (int u = box.x; u < box.x + box.width; ++u) {
            const double dx = u - centre_px.x();
            const double squared = dx * dx + dy * dy;
            if (squared > outer * outer || squared < inner * inner) continue;
            const auto sector = std::lround(std::atan2(dy, dx) * sectors_per_rad);
            sections[(sector + sectors) % sectors].push_back(
                {std::sqrt(squared) - radius_px, static_cast<double>(row[u])});
        }
    }
    return sections;
}

std::vector<EdgeSamples> samples_of_band(const cv::Mat& grey, const Eigen::Vector2d& from_px,
                                         const Eigen::Vector2d& to_px, const Eigen::Vector2d& outward,
                                         const Reach& reach, int stretches) {
    std::vector<EdgeSamples> sections(stretches);
    const double length = (to_px - from_px).norm();
    const Eigen::Vector2d along = (to_px - from_px) / length;
    const cv::Rect box = pixels_around(grey, from_px.cwiseMin(to_px), from_px.cwiseMax(to_px),
                                       std::max(reach.in_px, reach.out_px));
    for (int v = box.y; v < box.y + box.height; ++v) {
        const auto* row = grey.ptr<unsigned char>(v);
        for (int u = box.x; u < box.x + box.width; ++u) {
            const Eigen::Vector2d from_start = Eigen::Vector2d(u, v) - from_px;
            const double t = from_start.dot(outward);
            const double way = from_start.dot(along);
            if (t < -reach.in_px || t > reach.out_px || way < 0.0 || way >= length) continue;
            const int section = std::min(stretches - 1, static_cast<int>(way / length * stretches));
            sections[section].push_back({t, static_cast<double>(row[u])});
        }
    }
    return sections;
}

BinnedProfile binned_profile(std::span<const EdgeSample> samples) {
    const auto [least, most] =
        std::minmax_element(samples.begin(), samples.end(), [](auto a, auto b) { return a.t_px < b.t_px; });
    if (least == samples.end()) return {0.0, {}};
    BinnedProfile profile{least->t_px, {}};
    const auto bins = static_cast<std::size_t>(most->t_px - least->t_px) + 1;
    std::vector<double> sum(bins, 0.0);
    std::vector<int> count(bins, 0);
    for (const EdgeSample& sample : samples) {
        const auto bin = std::min(bins - 1, static_cast<std::size_t>(sample.t_px - profile.low_px));
        sum[bin] += sample.grey;
        ++count[bin];
    }
    for (std::size_t bin = 0; bin < bins; ++bin)
        profile.grey.push_back(count[bin] > 0 ? sum[bin] / count[bin] : profile.grey.back());
    return profile;
}

std::optional<double> coarse_step_px(std::span<const EdgeSample> samples, double sign, double least_grey) {
    constexpr std::size_t half = 3;
    const BinnedProfile profile = binned_profile(samples);
    std::optional<double> place;
    double greatest = least_grey;
    for (std::size_t bin = half; bin + half <= profile.grey.size(); ++bin) {
        double step = 0.0;
        for (std::size_t k = 0; k < half; ++k) step += profile.grey[bin + k] - profile.grey[bin - 1 - k];
        step *= sign / half;
        if (step <= greatest) continue;
        greatest = step;
        place = profile.low_px + static_cast<double>(bin);
    }
    return place;
}

}  // namespace fidservo::vision
