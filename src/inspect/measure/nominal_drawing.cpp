// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/nominal_drawing.h"

#include "core/camera/camera_parameters.h"
#include "plant/view/plate_view.h"
#include "src/inspect/recipe/pattern.h"
#include "src/inspect/recipe/seen_box.h"

#include <cmath>
#include <utility>
#include <variant>
#include <vector>

namespace fidservo::inspect {

namespace {

struct Middle {
    double x_mm, extent_mm;
};

struct MiddleOf {
    Middle operator()(const Dot& dot) const { return {dot.centre_mm.x(), dot.diameter_mm}; }
    Middle operator()(const Pad& pad) const { return {pad.centre_mm.x(), pad.size_mm.norm()}; }
    Middle operator()(const Line& line) const {
        return {(line.from_mm.x() + line.to_mm.x()) / 2, (line.to_mm - line.from_mm).norm() + line.width_mm};
    }
    Middle operator()(const Scratch& scratch) const {
        double length_mm = scratch.width_mm;
        for (std::size_t k = 1; k < scratch.points_mm.size(); ++k)
            length_mm += (scratch.points_mm[k] - scratch.points_mm[k - 1]).norm();
        return {scratch.points_mm.front().x(), length_mm};
    }
};

/// What can be in the picture, moved so that the axis is at y = 0: the drawing's camera moves along x alone.
Plate around(const Plate& plate, const CameraGeometry& camera, const Eigen::Vector2d& axis_mm) {
    const Box seen = box_around_seen(camera, axis_mm.x());
    const double room_mm = 0.1 * (seen.high_mm.x() - seen.low_mm.x());  // blur, and then some
    const auto is_far = [&](const Middle& middle) {
        const double reach_mm = middle.extent_mm + room_mm;
        return middle.x_mm < seen.low_mm.x() - reach_mm || middle.x_mm > seen.high_mm.x() + reach_mm;
    };
    Plate near = plate;
    std::erase_if(near.tags, [&](const PlateTag& tag) {
        return is_far({tag.centre_mm.x(), 2.0 * tag.side_mm});
    });
    std::erase_if(near.features,
                  [&](const Feature& feature) { return is_far(std::visit(MiddleOf{}, feature.shape)); });
    for (PlateTag& tag : near.tags) tag.centre_mm.y() -= axis_mm.y();
    for (Feature& feature : near.features) feature = moved(std::move(feature), {0.0, -axis_mm.y()});
    return near;
}

}  // namespace

DrawNominal nominal_drawing(const CameraParameters& camera, const Plate& nominal) {
    return [camera, nominal](const Eigen::Vector2d& axis_mm) {
        plant::ViewOptions ideal;
        ideal.noise = false;
        ideal.light = {.level = 1.0, .gradient = {0.0, 0.0}, .vignetting = 0.0};
        const double s_mm = axis_mm.x();
        return vision::ReferenceImage{
            plant::PlateView(camera, around(nominal, camera.geometry, axis_mm), ideal).render({&s_mm, 1}, 0),
            axis_mm, true};
    };
}

}  // namespace fidservo::inspect
