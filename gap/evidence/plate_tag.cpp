// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/evidence/plate_tag.h"

#include "core/rig.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace fidservo::gap {

bool shows_tags(const Recording& recording, const Rig& rig) {
    return rig.camera && (rig.fiducials || !recording.plate.empty());
}

std::optional<PlateTag> plate_tag(const Recording& recording, const Rig& rig, int id) {
    if (!recording.plate.empty()) {
        const auto found = std::ranges::find(recording.plate, id, &PlateTag::id);
        return found == recording.plate.end() ? std::nullopt : std::optional(*found);
    }
    if (!rig.fiducials) return std::nullopt;
    const FiducialParameters& grid = *rig.fiducials;
    const int index = id - grid.first_id;
    if (index < 0 || index >= grid.columns * grid.rows) return std::nullopt;
    const int column = index % grid.columns, row = index / grid.columns;
    return PlateTag{id, {column * grid.pitch_x_mm, row * grid.pitch_y_mm}, grid.side_mm, 0.0, grid.print};
}

std::array<Eigen::Vector2d, corner_count> plate_corners_mm(const PlateTag& tag) {
    const Eigen::Rotation2Dd turn(tag.angle_rad);
    std::array<Eigen::Vector2d, corner_count> corners_mm;
    for (std::size_t k = 0; k < corners_mm.size(); ++k)
        corners_mm[k] = tag.centre_mm + 0.5 * tag.side_mm * (turn * tag_corners[k]);
    return corners_mm;
}

}  // namespace fidservo::gap
