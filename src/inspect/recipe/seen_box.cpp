// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/seen_box.h"

#include <algorithm>
#include <array>
#include <limits>

namespace fidservo::inspect {
namespace {

/// The plate rectangle around one side of the image, and its middle.
struct Side {
    Box around;
    Eigen::Vector2d middle_mm;
};

/// The plate point at an image point; where a fisheye shows nothing of the plate, at the nearest one towards
/// the optical axis where it does.
Eigen::Vector2d plate_point_mm(const CameraGeometry& camera, const Eigen::Vector2d& image_px, double s_mm) {
    constexpr int steps = 64;
    Eigen::Vector2d place = back_project(camera, image_px, s_mm);
    for (int k = steps - 1; k >= 0 && !place.allFinite(); --k) {
        const double share = static_cast<double>(k) / steps;
        place = back_project(
            camera, camera.principal_point_px + share * (image_px - camera.principal_point_px), s_mm);
    }
    return place;
}

Side side_between(const CameraGeometry& camera, double s_mm, const Eigen::Vector2d& from_px,
                  const Eigen::Vector2d& to_px) {
    constexpr int steps = 16;  // a side bends by pixels at most: its chords miss hundredths
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Side side{{Eigen::Vector2d::Constant(infinity), Eigen::Vector2d::Constant(-infinity)},
              plate_point_mm(camera, 0.5 * (from_px + to_px), s_mm)};
    for (int k = 0; k <= steps; ++k) {
        const Eigen::Vector2d place =
            plate_point_mm(camera, from_px + static_cast<double>(k) / steps * (to_px - from_px), s_mm);
        side.around = {side.around.low_mm.cwiseMin(place), side.around.high_mm.cwiseMax(place)};
    }
    return side;
}

std::array<Side, 4> sides_of(const CameraGeometry& camera, double s_mm) {
    const double u = camera.width_px - 1.0, v = camera.height_px - 1.0;
    return {side_between(camera, s_mm, {0.0, 0.0}, {0.0, v}), side_between(camera, s_mm, {u, 0.0}, {u, v}),
            side_between(camera, s_mm, {0.0, 0.0}, {u, 0.0}), side_between(camera, s_mm, {0.0, v}, {u, v})};
}

}  // namespace

Box box_seen(const CameraGeometry& camera, double s_mm) {
    const std::array<Side, 4> sides = sides_of(camera, s_mm);
    Box seen;
    for (int axis = 0; axis < 2; ++axis) {  // whichever sides of the image bound it there
        const auto [low, high] = std::minmax_element(
            sides.begin(), sides.end(),
            [&](const Side& a, const Side& b) { return a.middle_mm[axis] < b.middle_mm[axis]; });
        seen.low_mm[axis] = low->around.high_mm[axis];
        seen.high_mm[axis] = high->around.low_mm[axis];
    }
    return seen;
}

Box box_around_seen(const CameraGeometry& camera, double s_mm) {
    const std::array<Side, 4> sides = sides_of(camera, s_mm);
    Box around = sides.front().around;
    for (const Side& side : sides)
        around = {around.low_mm.cwiseMin(side.around.low_mm), around.high_mm.cwiseMax(side.around.high_mm)};
    return around;
}

}  // namespace fidservo::inspect
