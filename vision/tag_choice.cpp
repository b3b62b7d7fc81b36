#include "vision/tag_choice.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fidservo::vision {
namespace {

/// Half the width of the upright box around border and quiet zone, mm: 10 cells of the 8 that the side has.
double half_box_mm(const PlateTag& tag) {
    constexpr double with_quiet_zone = 10.0 / 8.0;
    return 0.5 * with_quiet_zone * tag.side_mm *
           (std::abs(std::cos(tag.angle_rad)) + std::abs(std::sin(tag.angle_rad)));
}

/// Distance along the plate from the optical axis to the image's edges (outer edges of the outermost pixels).
struct Field {
    Eigen::Vector2d low_mm, high_mm;
};

Field field_of(const CameraGeometry& camera) {
    const double scale = mm_per_px(camera);
    const Eigen::Vector2d size(camera.width_px - 0.5, camera.height_px - 0.5);
    return {(Eigen::Vector2d(-0.5, -0.5) - camera.principal_point_px) * scale,
            (size - camera.principal_point_px) * scale};
}

}  // namespace

std::array<Eigen::Vector2d, 4> corners_mm(const PlateTag& tag) {
    const Eigen::Vector2d x =
        0.5 * tag.side_mm * Eigen::Vector2d(std::cos(tag.angle_rad), std::sin(tag.angle_rad));
    const Eigen::Vector2d y(-x.y(), x.x());
    return {tag.centre_mm - x + y, tag.centre_mm + x + y, tag.centre_mm + x - y, tag.centre_mm - x - y};
}

std::optional<ViewRange> view_range(const CameraGeometry& camera, const PlateTag& tag) {
    const Field field = field_of(camera);
    const double half = half_box_mm(tag);
    if (tag.centre_mm.y() - half < field.low_mm.y() || tag.centre_mm.y() + half > field.high_mm.y())
        return {};
    const ViewRange range{tag.centre_mm.x() + half - field.high_mm.x(),
                          tag.centre_mm.x() - half - field.low_mm.x()};
    if (range.low_mm > range.high_mm) return {};
    return range;
}

std::vector<PlateTag> visible_tags(const CameraGeometry& camera, const Plate& plate, double s_mm) {
    std::vector<PlateTag> visible;
    for (const PlateTag& tag : plate.tags) {
        const std::optional<ViewRange> range = view_range(camera, tag);
        if (range && s_mm >= range->low_mm && s_mm <= range->high_mm) visible.push_back(tag);
    }
    const auto from_axis = [&](const PlateTag& tag) {
        return (tag.centre_mm - Eigen::Vector2d(s_mm, 0.0)).norm();
    };
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
