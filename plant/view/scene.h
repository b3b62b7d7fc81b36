// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The things to be painted of a plate: shapes in px, in the order in which they overlap.
#include "core/plate.h"
#include "plant/view/cell_grid.h"
#include "plant/view/disc.h"
#include "plant/view/image_map.h"
#include "plant/view/scratch_path.h"
#include "plant/view/view_options.h"

#include <memory>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace fidservo::plant::view {

using Shape = std::variant<CellGrid, Disc, ScratchPath>;

struct Item {
    std::shared_ptr<const Shape> shape;
    Eigen::Vector2d centre_mm;
    float reflectance;
};

/// Tags, then the features in their order, then the occluders; later ones cover earlier ones. Throws
/// InputError for an unknown tag and for a shape without an area.
std::vector<Item> scene_of(const Plate& plate, const std::vector<Feature>& occluders, double blur_px,
                           const ImageMap& map);

Eigen::Vector2d half_extent_px(const Shape& shape);

/// Coverage of the pixels (du, dv), (du + 1, dv), ... relative to the shape's centre, in px.
void cover(const Shape& shape, double du, double dv, std::span<float> coverage);

/// Coverage of the pixels at places (du, dv) relative to the shape's centre, in px.
void cover_at(const Shape& shape, std::span<const double> du, std::span<const double> dv,
              std::span<float> coverage);

}  // namespace fidservo::plant::view
