// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/camera/camera_geometry.h"
#include "core/plate.h"
#include "core/rig.h"
#include "src/files/rig/plate_file.h"
#include "src/inspect/recipe/seen_box.h"
#include "src/rig/finding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// The black border is eight modules wide; the white module around it belongs to the tag.
/// Below it the border of a tag cannot be measured (docs/formats.md, what replay writes).
constexpr double least_side_px = 32.0;
/// A lens that draws straight lines straight has an image of 90 degrees at most, with few exceptions: the
/// focal length is then half of its width. A hundred widths would be a telescope.
constexpr double least_focal_widths = 0.5, most_focal_widths = 100.0;
/// Of the platform's travel. With fewer pixels than that the camera tells a motion of the platform to no
/// more than a part in a thousand, though it finds tags to 0.02 px; with a view of less than a quarter of
/// it, whatever is seen at one end has left the image long before the other.
constexpr double least_travel_px = 40.0, most_travel_views = 4.0;
/// A frame that comes later than the supervisor waits for one (control/positioner.h).
constexpr double longest_latency_s = 0.5;

double view_mm(const CameraGeometry& camera) {
    const inspect::Box seen = inspect::box_seen(camera, 0.0);
    return seen.high_mm.x() - seen.low_mm.x();
}

void look_at_camera(const Rig& rig, std::vector<Finding>& findings) {
    const CameraParameters& camera = *rig.camera;
    const CameraGeometry& geometry = camera.geometry;
    const double widths = geometry.focal_px / geometry.width_px;
    const bool draws_straight = geometry.distortion.model == LensModel::plumb_bob;
    if ((draws_straight && widths < least_focal_widths) || widths > most_focal_widths)
        findings.push_back(
            {"camera.focal_px", fmt::format("{:g}", geometry.focal_px),
             fmt::format(
                 "an image of {} px would be {:.3g} degrees wide", geometry.width_px,
                 (draws_straight ? 2.0 * std::atan(0.5 / widths) : 1.0 / widths) * 180.0 / std::numbers::pi),
             fmt::format("{:g} to {:g}: the lens' focal length / a pixel's size, both in mm",
                         least_focal_widths * geometry.width_px, most_focal_widths * geometry.width_px)});
    const Eigen::Vector2d middle_px(0.5 * (geometry.width_px - 1), 0.5 * (geometry.height_px - 1));
    const Eigen::Vector2d off_px = (geometry.principal_point_px - middle_px).cwiseAbs();
    // A quarter of the image: lenses are screwed on to about a twentieth.
    if (off_px.x() > 0.25 * geometry.width_px || off_px.y() > 0.25 * geometry.height_px)
        findings.push_back(
            {"camera.principal_point_px",
             fmt::format("[{:g}, {:g}]", geometry.principal_point_px.x(), geometry.principal_point_px.y()),
             "far from the middle of the image",
             fmt::format("about [{:g}, {:g}]", middle_px.x(), middle_px.y())});
    if (camera.latency_s > longest_latency_s)
        findings.push_back({"camera.latency_s", fmt::format("{:g}", camera.latency_s),
                            "a frame would come later than a motion waits for one",
                            fmt::format("one to three frames, {:.3g} s; at most {:g} s",
                                        2.0 / camera.frame_rate_hz, longest_latency_s)});
    if (!rig.micro) return;
    const double travel_mm = rig.micro->high_mm - rig.micro->low_mm, scale_mm = mm_per_px(geometry);
    if (travel_mm < least_travel_px * scale_mm || travel_mm > most_travel_views * view_mm(geometry))
        findings.push_back(
            {"camera.distance_mm", fmt::format("{:g}", geometry.distance_mm),
             fmt::format(
                 "with focal_px {:g} a pixel is {:.3g} um: the platform's travel of {:g} mm is {:.3g} px, "
                 "{:.3g} images",
                 geometry.focal_px, 1e3 * scale_mm, travel_mm, travel_mm / scale_mm,
                 travel_mm / view_mm(geometry)),
             fmt::format("more than {:g} px and at most {:g} images", least_travel_px, most_travel_views)});
}

/// Camera positions, plate x.
struct Stretch {
    double low_mm, high_mm;
    double length_mm() const { return high_mm - low_mm; }
};

/// From where no tag is whole in the image. A tag's white margin counts.
std::vector<Stretch> blind_stretches(const Rig& rig, const Stretch& travel) {
    const CameraGeometry& camera = rig.camera->geometry;
    const Plate plate = plate_of(*rig.fiducials);
    const double half_mm = 0.5 * rig.fiducials->print.share_with_zone() * rig.fiducials->side_mm;
    const double step_mm = std::min(0.1 * view_mm(camera), 0.1 * travel.length_mm());
    std::vector<Stretch> blind;
    bool was_blind = false;
    const auto steps = static_cast<int>(std::ceil(travel.length_mm() / step_mm));
    for (int k = 0; k <= steps; ++k) {
        const double s_mm = std::min(travel.high_mm, travel.low_mm + k * step_mm);
        const inspect::Box seen = inspect::box_seen(camera, s_mm);
        const bool is_blind = std::ranges::none_of(plate.tags, [&](const PlateTag& tag) {
            return (tag.centre_mm.array() - half_mm >= seen.low_mm.array()).all() &&
                   (tag.centre_mm.array() + half_mm <= seen.high_mm.array()).all();
        });
        if (is_blind && !was_blind) blind.push_back({s_mm, s_mm});
        if (is_blind) blind.back().high_mm = s_mm;
        was_blind = is_blind;
    }
    return blind;
}

void look_over_travel(const Rig& rig, std::vector<Finding>& findings) {
    const double low_mm = rig.micro ? rig.micro->low_mm : 0.0, high_mm = rig.micro ? rig.micro->high_mm : 0.0;
    const Stretch travel{rig.macro.low_mm + low_mm, rig.macro.high_mm + high_mm};
    const std::vector<Stretch> blind = blind_stretches(rig, travel);
    const FiducialParameters& tags = *rig.fiducials;
    const std::string count = fmt::format("[{}, {}]", tags.columns, tags.rows);
    const double last_mm = (tags.columns - 1) * tags.pitch_x_mm;
    if (blind.size() == 1 && blind[0].length_mm() >= travel.length_mm()) {
        findings.push_back(
            {"fiducials.count", count,
             fmt::format("no tag is whole in the image anywhere in the travel, {:g} to {:g} mm",
                         travel.low_mm, travel.high_mm),
             fmt::format("tags in the travel; these stand at 0 to {:g} mm", last_mm)});
        return;
    }
    // At the ends of the travel the platform, or half an image, brings the next tag into view.
    const double end_mm = std::max(high_mm - low_mm, 0.5 * view_mm(rig.camera->geometry));
    for (const Stretch& stretch : blind) {
        const bool at_end = stretch.low_mm <= travel.low_mm || stretch.high_mm >= travel.high_mm;
        if (at_end && stretch.length_mm() <= end_mm) continue;
        findings.push_back(
            {at_end ? "fiducials.count" : "fiducials.pitch_mm",
             at_end ? count : fmt::format("[{:g}, {:g}]", tags.pitch_x_mm, tags.pitch_y_mm),
             fmt::format("from {:.4g} to {:.4g} mm no tag is whole in the image{}", stretch.low_mm,
                         stretch.high_mm, at_end ? "" : ", and so between other tags"),
             at_end
                 ? fmt::format("tags up to the ends of the travel; these stand at 0 to {:g} mm", last_mm)
                 : fmt::format("tags of {:g} mm at most {:.3g} mm apart", tags.side_mm,
                               view_mm(rig.camera->geometry) - tags.print.share_with_zone() * tags.side_mm)});
        if (!at_end) return;
    }
}

void look_at_tags(const Rig& rig, std::vector<Finding>& findings) {
    const CameraGeometry& camera = rig.camera->geometry;
    const double side_mm = rig.fiducials->side_mm, with_margin = rig.fiducials->print.share_with_zone();
    const std::string side = fmt::format("{:g}", side_mm);
    const double side_px = side_mm / mm_per_px(camera);
    const double view_px = std::min(camera.width_px, camera.height_px);
    if (side_px < least_side_px)
        findings.push_back(
            {"fiducials.side_mm", side,
             fmt::format("a tag is {:.3g} px in the image: its border cannot be measured", side_px),
             fmt::format("at least {:g} px, {:.3g} mm", least_side_px, least_side_px * mm_per_px(camera))});
    else if (with_margin * side_px > view_px)
        findings.push_back(
            {"fiducials.side_mm", side,
             fmt::format("with its white margin a tag is {:.4g} px in an image of {} x {}: never whole",
                         with_margin * side_px, camera.width_px, camera.height_px),
             fmt::format("at most {:.3g} mm", view_px / with_margin * mm_per_px(camera))});
    else
        look_over_travel(rig, findings);
}

}  // namespace

std::vector<Finding> sight_findings(const Rig& rig) {
    std::vector<Finding> findings;
    if (!rig.camera) return findings;
    look_at_camera(rig, findings);
    if (rig.fiducials) look_at_tags(rig, findings);
    return findings;
}

std::vector<Finding> findings_of(const Rig& rig) {
    std::vector<Finding> all;
    for (const auto look : {axis_findings, micro_findings, loop_findings, sight_findings})
        for (Finding& finding : look(rig)) all.push_back(std::move(finding));
    return all;
}

}  // namespace fidservo
