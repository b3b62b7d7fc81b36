// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/outline.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace fidservo::inspect {
namespace {

constexpr int circle_points = 48;

struct NominalOutline {
    const vision::RestImage& image;
    Outline operator()(const Dot& dot) const { return circle(image, dot.centre_mm, dot.diameter_mm); }
    Outline operator()(const Pad& pad) const {
        return rectangle(image, pad.centre_mm, pad.size_mm, pad.angle_rad);
    }
    Outline operator()(const Line& line) const {
        const Eigen::Vector2d along = line.to_mm - line.from_mm;
        return rectangle(image, (line.from_mm + line.to_mm) / 2, {along.norm(), line.width_mm},
                         std::atan2(along.y(), along.x()));
    }
    Outline operator()(const Scratch& scratch) const {
        Outline outline;
        for (const Eigen::Vector2d& point_mm : scratch.points_mm)
            outline.push_back(to_image(image, point_mm));
        return outline;
    }
};

}  // namespace

Outline circle(const vision::RestImage& image, const Eigen::Vector2d& centre_mm, double diameter_mm) {
    Outline outline;
    for (int k = 0; k < circle_points; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / circle_points;
        outline.push_back(
            to_image(image, centre_mm + diameter_mm / 2 * Eigen::Vector2d(std::cos(angle), std::sin(angle))));
    }
    return outline;
}

Outline rectangle(const vision::RestImage& image, const Eigen::Vector2d& centre_mm,
                  const Eigen::Vector2d& size_mm, double angle_rad) {
    const Eigen::Rotation2Dd turned(angle_rad);
    Outline outline;
    for (const auto& [x, y] :
         {std::pair(-0.5, -0.5), std::pair(0.5, -0.5), std::pair(0.5, 0.5), std::pair(-0.5, 0.5)})
        outline.push_back(
            to_image(image, centre_mm + turned * Eigen::Vector2d(x * size_mm.x(), y * size_mm.y())));
    return outline;
}

Outline outline_of(const vision::RestImage& image, const Feature& feature) {
    return std::visit(NominalOutline{image}, feature.shape);
}

}  // namespace fidservo::inspect
