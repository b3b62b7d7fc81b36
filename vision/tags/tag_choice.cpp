// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/tag_choice.h"

#include "core/camera/camera_slopes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

namespace fidservo::vision {
namespace {

/// Half the width of the upright box around border and quiet zone, mm.
double half_box_mm(const PlateTag& tag) {
    return 0.5 * tag.print.share_with_zone() * tag.side_mm *
           (std::abs(std::cos(tag.angle_rad)) + std::abs(std::sin(tag.angle_rad)));
}

/// Of a camera that looks straight down: distance along the plate from the optical axis to the image's edges
/// (outer edges of the outermost pixels).
struct Field {
    Eigen::Vector2d low_mm, high_mm;
};

Field field_of(const CameraGeometry& camera) {
    const double scale = mm_per_px(camera);
    const Eigen::Vector2d size(camera.width_px - 0.5, camera.height_px - 0.5);
    return {(Eigen::Vector2d(-0.5, -0.5) - camera.principal_point_px) * scale,
            (size - camera.principal_point_px) * scale};
}

std::optional<ViewRange> straight_view_range(const CameraGeometry& camera, const PlateTag& tag) {
    const Field field = field_of(camera);
    const double half = half_box_mm(tag);
    if (tag.centre_mm.y() - half < field.low_mm.y() || tag.centre_mm.y() + half > field.high_mm.y())
        return {};
    const ViewRange range{tag.centre_mm.x() + half - field.high_mm.x(),
                          tag.centre_mm.x() - half - field.low_mm.x()};
    if (range.low_mm > range.high_mm) return {};
    return range;
}

/// Smallest distance inside the image, px, of the corners and the sides' middles of border and quiet zone;
/// negative: not wholly in view.
double room_px(const CameraGeometry& camera, const PlateTag& tag, double s_mm) {
    constexpr double out_of_sight_px = -1e9;
    const PlateTag with_zone{tag.id, tag.centre_mm, tag.print.share_with_zone() * tag.side_mm, tag.angle_rad};
    const std::array<Eigen::Vector2d, 4> corners = corners_mm(with_zone);
    double room = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 4; ++k)
        for (const Eigen::Vector2d& point :
             {corners[k], Eigen::Vector2d(0.5 * (corners[k] + corners[(k + 1) % 4]))}) {
            const Eigen::Vector2d at = project(camera, point, s_mm);
            room = std::min({room, at.x() + 0.5, camera.width_px - 0.5 - at.x(), at.y() + 0.5,
                             camera.height_px - 0.5 - at.y()});
            // Far outside, a lens that bends inwards may show a point a second time, or not at all.
            if (room >= 0.0 && !((back_project(camera, at, s_mm) - point).norm() <= 1e-3 * tag.side_mm))
                return out_of_sight_px;
        }
    return room;
}

/// Where a function that falls on both sides of `inside` crosses zero between there and `outside`.
template <class Function>
double zero_between(double inside, double outside, Function function) {
    constexpr int halvings = 48;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (inside + outside);
        (function(middle) >= 0.0 ? inside : outside) = middle;
    }
    return inside;
}

/// The room has one maximum along the stage's way; found by golden section, then the ends by halving.
std::optional<ViewRange> general_view_range(const CameraGeometry& camera, const PlateTag& tag) {
    const Eigen::Vector2d middle_px(0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1));
    const double from_zero_mm = back_project(camera, middle_px, 0.0).x();
    const double centred_s_mm =
        (tag.centre_mm.x() - from_zero_mm) / (back_project(camera, middle_px, 1.0).x() - from_zero_mm);
    const double field_mm = camera.width_px * mm_per_px_at(camera, middle_px, centred_s_mm);
    const auto room_at = [&](double s_mm) { return room_px(camera, tag, s_mm); };

    double low = centred_s_mm - 0.6 * field_mm, high = centred_s_mm + 0.6 * field_mm;
    const double first = low, last = high;
    constexpr int cuts = 40;
    for (int k = 0; k < cuts; ++k) {
        const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        if (room_at(left) < room_at(right))
            low = left;
        else
            high = right;
    }
    const double best = 0.5 * (low + high);
    if (room_at(best) < 0.0) return {};
    return ViewRange{zero_between(best, first, room_at), zero_between(best, last, room_at)};
}

}  // namespace

std::array<Eigen::Vector2d, 4> corners_mm(const PlateTag& tag) {
    const Eigen::Vector2d x =
        0.5 * tag.side_mm * Eigen::Vector2d(std::cos(tag.angle_rad), std::sin(tag.angle_rad));
    const Eigen::Vector2d y(-x.y(), x.x());
    return {tag.centre_mm - x + y, tag.centre_mm + x + y, tag.centre_mm + x - y, tag.centre_mm - x - y};
}

std::optional<ViewRange> view_range(const CameraGeometry& camera, const PlateTag& tag) {
    return looks_straight(camera) ? straight_view_range(camera, tag) : general_view_range(camera, tag);
}

std::vector<PlateTag> visible_tags(const CameraGeometry& camera, const Plate& plate, double s_mm) {
    std::vector<PlateTag> visible;
    const auto is_visible = [&](const PlateTag& tag) {
        if (!looks_straight(camera)) return room_px(camera, tag, s_mm) >= 0.0;
        const std::optional<ViewRange> range = straight_view_range(camera, tag);
        return range && s_mm >= range->low_mm && s_mm <= range->high_mm;
    };
    std::copy_if(plate.tags.begin(), plate.tags.end(), std::back_inserter(visible), is_visible);
    const Eigen::Vector2d axis_mm = back_project(camera, camera.principal_point_px, s_mm);
    const auto from_axis = [&](const PlateTag& tag) { return (tag.centre_mm - axis_mm).norm(); };
    std::sort(visible.begin(), visible.end(), [&](const PlateTag& a, const PlateTag& b) {
        return std::tuple(from_axis(a), a.id) < std::tuple(from_axis(b), b.id);
    });
    return visible;
}

std::optional<PlateTag> tag_to_use(const CameraGeometry& camera, const Plate& plate, double s_mm) {
    const std::vector<PlateTag> visible = visible_tags(camera, plate, s_mm);
    if (visible.empty()) return {};
    return visible.front();
}

bool row_is_reachable(const CameraGeometry& camera, const PlateTag& tag) {
    return view_range(camera, tag).has_value();
}

std::vector<PlateTag> reachable_rows(const CameraGeometry& camera, const Plate& plate) {
    std::vector<PlateTag> reachable;
    std::copy_if(plate.tags.begin(), plate.tags.end(), std::back_inserter(reachable),
                 [&](const PlateTag& tag) { return row_is_reachable(camera, tag); });
    return reachable;
}

std::optional<PlateTag> find_tag(const Plate& plate, int tag_id) {
    const auto found = std::find_if(plate.tags.begin(), plate.tags.end(),
                                    [&](const PlateTag& tag) { return tag.id == tag_id; });
    if (found == plate.tags.end()) return {};
    return *found;
}

}  // namespace fidservo::vision
