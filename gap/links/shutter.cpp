// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/shutter.h"

#include "core/camera/camera_parameters.h"
#include "core/median.h"
#include "gap/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fidservo::gap {
namespace {

constexpr double least_px_per_s = 300.0;
constexpr std::size_t fewest = 5;

/// Adds the exposure that explains by how much an edge across a tag's motion is wider than one along it; adds
/// nothing where it is not wider or the tag is too slow.
void add_exposure(std::vector<double>& exposures_s, const TagAppearance& seen,
                  const Eigen::Vector2d& velocity_px_per_s) {
    const auto along = [&](const TagSide& side) { return std::abs(side.normal.dot(velocity_px_per_s)); };
    const auto [least, most] = std::ranges::minmax_element(seen.sides, {}, along);
    const double widened_px2 = most->variance_px2 - least->variance_px2;
    const double speeds2 = std::pow(along(*most), 2) - std::pow(along(*least), 2);
    if (speeds2 > std::pow(least_px_per_s, 2) && widened_px2 > 0.0)
        exposures_s.push_back(std::sqrt(uniform_divisor * widened_px2 / speeds2));
}

/// From the middle of a tag's two upper corners to that of its two lower ones, px.
Eigen::Vector2d downwards_px(std::array<Eigen::Vector2d, corner_count> corners_px) {
    std::ranges::sort(corners_px, {}, [](const Eigen::Vector2d& corner) { return corner.y(); });
    return 0.5 * (corners_px[2] + corners_px.back() - corners_px.front() - corners_px[1]);
}

double seen_readout_s(std::span<const ImageRun> images, int height_px) {
    constexpr double still_px_per_s = 20.0;
    std::vector<double> still_u, still_v, readouts_s;
    for (const ImageRun& run : images)
        for (const ImageSighting& tag : run.sightings) {
            if (tag.velocity_px_per_s.norm() > still_px_per_s) continue;
            const Eigen::Vector2d shape_px = downwards_px(tag.corners_px);
            still_u.push_back(shape_px.x());
            still_v.push_back(shape_px.y());
        }
    if (still_u.size() < fewest) return 0.0;
    const Eigen::Vector2d still_px(median_of(still_u), median_of(still_v));
    for (const ImageRun& run : images)
        for (const ImageSighting& tag : run.sightings) {
            const double speed = tag.velocity_px_per_s.norm();
            if (speed > least_px_per_s)
                readouts_s.push_back((downwards_px(tag.corners_px) - still_px).dot(tag.velocity_px_per_s) /
                                     (speed * speed) * (height_px - 1) / still_px.y());
        }
    return readouts_s.size() < fewest ? 0.0 : median_of(readouts_s);
}

}  // namespace

Shutter seen_shutter(std::span<const Recording> recordings, std::span<const ImageRun> images,
                     const CameraParameters& camera) {
    std::vector<double> exposures_s;
    for (std::size_t run = 0; run < recordings.size(); ++run)
        for (std::size_t i = 0; i < images[run].sightings.size(); ++i)
            add_exposure(exposures_s, recordings[run].appearances[i],
                         images[run].sightings[i].velocity_px_per_s);
    const double exposure_s = exposures_s.size() < fewest ? 0.0 : median_of(exposures_s);
    return {std::max(camera.exposure_s, exposure_s), seen_readout_s(images, camera.geometry.height_px)};
}

}  // namespace fidservo::gap
