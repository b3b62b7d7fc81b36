// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/sheared_tags.h"

#include "core/rig.h"
#include "gap/links/tag_link.h"
#include "gap/numbers.h"

#include <cstddef>
#include <optional>
#include <span>

namespace fidservo::gap {
namespace {

/// What a readout of 1 s does to the turned values; empty where no near frame before and after shows the tag.
std::optional<CornerValues> shear(const TagSighting& before, const TagSighting& tag, const TagSighting& after,
                                  const CameraParameters& camera) {
    constexpr double late = 1.0 + most_steps_apart;
    const double way_s = after.stamp_s - before.stamp_s;
    if (!(way_s > 0.0) || way_s > late / camera.frame_rate_hz) return std::nullopt;
    const CornerValues way_px = after.corners_px - before.corners_px;
    Eigen::Vector2d velocity_px_per_s = Eigen::Vector2d::Zero();
    double row = 0.0;
    for (int c = 0; c < corner_count; ++c) {
        velocity_px_per_s += corner_share * way_px.segment<2>(2 * c) / way_s;
        row += corner_share * tag.corners_px[2 * c + 1];
    }
    CornerValues off;
    for (int c = 0; c < corner_count; ++c)
        off.segment<2>(2 * c) =
            velocity_px_per_s * (tag.corners_px[2 * c + 1] - row) / (camera.geometry.height_px - 1.0);
    return turned(tag, off);
}

/// The next sighting of the same tag, among those of a window; null where there is none.
const TagSighting* next_of_tag(std::span<const TagSighting> sightings, std::size_t i, std::ptrdiff_t step) {
    const auto count = static_cast<std::ptrdiff_t>(sightings.size());
    for (auto k = static_cast<std::ptrdiff_t>(i) + step; k >= 0 && k < count; k += step) {
        const TagSighting& other = sightings[static_cast<std::size_t>(k)];
        if (other.is_known && other.centre_mm == sightings[i].centre_mm) return &other;
    }
    return nullptr;
}

}  // namespace

bool tags_are_sheared(const Evidence& evidence, const Errors& errors) {
    constexpr double least_share = 0.7;
    double squares = 0.0, product = 0.0, shears = 0.0;
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::tag) continue;
        const std::size_t tags = (window.end - window.begin) / corner_values;
        if (tags == 0) continue;
        const std::span sightings(&evidence.sighting(window.run, window.first_detection), tags);
        for (std::size_t i = 0; i < tags; ++i) {
            const TagSighting *before = next_of_tag(sightings, i, -1), *after = next_of_tag(sightings, i, 1);
            if (!sightings[i].is_known || before == nullptr || after == nullptr) continue;
            const auto off = shear(*before, sightings[i], *after, *evidence.rig().camera);
            if (!off) continue;
            const CornerValues floors = off->cwiseQuotient(sightings[i].floors_px);
            for (std::size_t k = 1; k < corner_values; ++k) {
                const double error = errors[window.begin + corner_values * i + k],
                             sheared = floors[static_cast<Eigen::Index>(k)];
                squares += error * error;
                product += error * sheared;
                shears += sheared * sheared;
            }
        }
    }
    return product * product > least_share * squares * shears && squares > 0.0;
}

}  // namespace fidservo::gap
