#include "gap/sheared_tags.h"

#include "gap/tag_link.h"

#include <cstddef>
#include <optional>

namespace fidservo::gap {
namespace {

/// What a readout of 1 s does to the turned values; empty where a neighbouring frame does not show the tag.
std::optional<CornerValues> shear(const TagSighting& before, const TagSighting& tag, const TagSighting& after,
                                  const CameraParameters& camera) {
    constexpr double late = 2.5;
    const double way_s = after.stamp_s - before.stamp_s;
    if (before.centre_mm != tag.centre_mm || after.centre_mm != tag.centre_mm || !(way_s > 0.0) ||
        way_s > late / camera.frame_rate_hz)
        return std::nullopt;
    const CornerValues way_px = after.corners_px - before.corners_px;
    Eigen::Vector2d velocity_px_per_s = Eigen::Vector2d::Zero();
    double row = 0.0;
    for (int c = 0; c < 4; ++c) {
        velocity_px_per_s += 0.25 * way_px.segment<2>(2 * c) / way_s;
        row += 0.25 * tag.corners_px[2 * c + 1];
    }
    CornerValues off;
    for (int c = 0; c < 4; ++c)
        off.segment<2>(2 * c) =
            velocity_px_per_s * (tag.corners_px[2 * c + 1] - row) / (camera.geometry.height_px - 1.0);
    return turned(tag, off);
}

}  // namespace

bool tags_are_sheared(const Evidence& evidence, const Errors& errors) {
    constexpr double least_share = 0.7;
    double squares = 0.0, product = 0.0, shears = 0.0;
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::tag) continue;
        const std::size_t tags = (window.end - window.begin) / corner_values;
        for (std::size_t i = 1; i + 1 < tags; ++i) {
            const auto sighting = [&](std::size_t k) -> const TagSighting& {
                return evidence.sighting(window.run, window.first_detection + k);
            };
            const auto off = shear(sighting(i - 1), sighting(i), sighting(i + 1), *evidence.rig().camera);
            if (!off || !sighting(i).is_known) continue;
            const CornerValues floors = off->cwiseQuotient(sighting(i).floors_px);
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
