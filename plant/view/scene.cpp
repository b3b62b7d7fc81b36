// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/view/scene.h"

#include "core/input_error.h"
#include "plant/view/tag_code.h"

#include <cmath>
#include <map>
#include <string>

namespace fidservo::plant::view {

namespace {

/// Builds shapes; edges of one angle and dots of one size share their tables.
class ShapeMaker {
  public:
    ShapeMaker(double blur_px, const ImageMap& map) : blur_px_(blur_px), map_(map) {}

    Item tag(const PlateTag& tag, const Plate& plate) {
        demand_area("tag " + std::to_string(tag.id), "side_mm", tag.side_mm);
        PrintedTag printed = printed_tag(tag);
        return grid(std::move(printed.pattern), tag.centre_mm, Eigen::Vector2d::Constant(printed.side_mm),
                    tag.angle_rad, plate.ink_reflectance);
    }

    Item feature(const Feature& feature) {
        return std::visit([&](const auto& shape) { return make(shape, feature); }, feature.shape);
    }

  private:
    static void demand_area(const std::string& what, const char* key, double length_mm) {
        if (length_mm > 0.0) return;
        throw InputError("plate: " + what + ": " + key + ": " + std::to_string(length_mm) +
                         "; allowed: above 0");
    }

    Item grid(CellPattern pattern, const Eigen::Vector2d& centre_mm, const Eigen::Vector2d& size_mm,
              double angle_rad, double reflectance) {
        const double angle = map_.angle_rad(angle_rad);
        auto& edge = edges_[angle];
        if (!edge) edge = std::make_shared<EdgeProfile>(EdgeProfile::of_pixel(blur_px_, angle));
        const Eigen::Vector2d size_px(map_.length_px(size_mm.x()), map_.length_px(size_mm.y()));
        return {std::make_shared<Shape>(CellGrid(std::move(pattern), size_px, angle, edge)), centre_mm,
                static_cast<float>(reflectance)};
    }

    Item make(const Pad& pad, const Feature& feature) {
        demand_area(feature.name, "size_mm", pad.size_mm.minCoeff());
        return grid({}, pad.centre_mm, pad.size_mm, pad.angle_rad, feature.reflectance);
    }

    Item make(const Line& line, const Feature& feature) {
        const Eigen::Vector2d along = line.to_mm - line.from_mm;
        demand_area(feature.name, "width_mm", line.width_mm);
        demand_area(feature.name, "length", along.norm());
        return grid({}, 0.5 * (line.from_mm + line.to_mm), {along.norm(), line.width_mm},
                    std::atan2(along.y(), along.x()), feature.reflectance);
    }

    Item make(const Dot& dot, const Feature& feature) {
        demand_area(feature.name, "diameter_mm", dot.diameter_mm);
        auto& disc = discs_[dot.diameter_mm];
        if (!disc) {
            disc =
                std::make_shared<Shape>(Disc(map_.length_px(dot.diameter_mm), blur_with_pixel_px(blur_px_)));
        }
        return {disc, dot.centre_mm, static_cast<float>(feature.reflectance)};
    }

    Item make(const Scratch& scratch, const Feature& feature) {
        demand_area(feature.name, "width_mm", scratch.width_mm);
        demand_area(feature.name, "number of points after the first",
                    static_cast<double>(scratch.points_mm.size()) - 1.0);
        const Eigen::Vector2d centre_mm = 0.5 * (scratch.points_mm.front() + scratch.points_mm.back());
        std::vector<Eigen::Vector2d> points_px;
        for (const Eigen::Vector2d& point : scratch.points_mm) {
            points_px.push_back(map_.displacement_px(point - centre_mm));
            if (points_px.size() < 2) continue;
            demand_area(feature.name, "distance between successive points",
                        (points_px.back() - points_px[points_px.size() - 2]).norm());
        }
        const double width_px = map_.length_px(scratch.width_mm);
        return {std::make_shared<Shape>(ScratchPath(points_px, width_px, blur_with_pixel_px(blur_px_))),
                centre_mm, static_cast<float>(feature.reflectance)};
    }

    double blur_px_;
    const ImageMap& map_;
    std::map<double, std::shared_ptr<const EdgeProfile>> edges_;
    std::map<double, std::shared_ptr<const Shape>> discs_;
};

}  // namespace

std::vector<Item> scene_of(const Plate& plate, const std::vector<Feature>& occluders, double blur_px,
                           const ImageMap& map) {
    ShapeMaker maker(blur_px, map);
    std::vector<Item> items;
    for (const PlateTag& tag : plate.tags) items.push_back(maker.tag(tag, plate));
    for (const Feature& feature : plate.features) items.push_back(maker.feature(feature));
    for (const Feature& occluder : occluders) items.push_back(maker.feature(occluder));
    return items;
}

Eigen::Vector2d half_extent_px(const Shape& shape) {
    return std::visit([](const auto& any) { return any.half_extent_px(); }, shape);
}

void cover(const Shape& shape, double du, double dv, std::span<float> coverage) {
    std::visit([&](const auto& any) { any.cover(du, dv, coverage); }, shape);
}

void cover_at(const Shape& shape, std::span<const double> du, std::span<const double> dv,
              std::span<float> coverage) {
    std::visit([&](const auto& any) { any.cover_at(du, dv, coverage); }, shape);
}

}  // namespace fidservo::plant::view
