// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/reach.h"

#include "core/rig.h"
#include "core/units.h"
#include "src/inspect/recipe/clip.h"
#include "src/inspect/recipe/seen_box.h"
#include "src/session/motion_params.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::inspect {
namespace {

Box grown(Box box, double by_mm) {
    return {box.low_mm.array() - by_mm, box.high_mm.array() + by_mm};
}

Box square(const Eigen::Vector2d& centre_mm, double half_mm) {
    return grown({centre_mm, centre_mm}, half_mm);
}

bool inside(const Box& inner, const Box& outer) {
    return (inner.low_mm.array() >= outer.low_mm.array()).all() &&
           (inner.high_mm.array() <= outer.high_mm.array()).all();
}

/// Length of the part of a line that lies in the box.
double length_within(const Line& line, const Box& box) {
    const auto part = clipped(line.from_mm, line.to_mm, box);
    return part ? (part->second - part->first).norm() : 0.0;
}

const CameraGeometry& geometry_of(const YamlValue& where, const Rig& rig) {
    if (!rig.camera) where.fail("this rig has no camera: nothing can be inspected");
    return rig.camera->geometry;
}

double half_extent_mm(const PlateTag& tag) {
    return 0.5 * tag.print.share_with_zone() * tag.side_mm *
           (std::abs(std::cos(tag.angle_rad)) + std::abs(std::sin(tag.angle_rad)));
}

/// What one check needs to find in the image.
class ViewChecker {
  public:
    ViewChecker(const YamlValue& where, const CameraGeometry& camera, const Plate& plate, const Site& site,
                const View& view)
        : where_(where),
          plate_(plate),
          site_(site),
          view_(view),
          seen_(box_seen(camera, site.fiducial_mm.x() + mm_from_um(view.offset_um))),
          mm_per_px_(mm_per_px(camera)) {}

    void operator()(const PlacementCheck&) const {}
    void operator()(const ReferenceCheck&) const {}
    void operator()(const MarkCheck& check) const {
        const Feature& feature = named(check.feature);
        Box box;
        if (const auto* dot = std::get_if<Dot>(&feature.shape)) {
            box = square(dot->centre_mm, dot->diameter_mm / 2);
        } else if (const auto* pad = std::get_if<Pad>(&feature.shape)) {
            box = square(pad->centre_mm, pad->size_mm.norm() / 2);
            if (pad->angle_rad == 0.0)
                box = {pad->centre_mm - pad->size_mm / 2, pad->centre_mm + pad->size_mm / 2};
        } else {
            fail(check.feature, "is no dot and no pad: a mark check cannot measure it");
        }
        if (!inside(grown(box, mm_from_um(check.search_um)), seen_))
            fail(check.feature,
                 fmt::format("is not wholly in view, with {} um around it to search", check.search_um));
    }
    void operator()(const LineCheck& check) const {
        const auto* line = std::get_if<Line>(&named(check.feature).shape);
        if (!line) fail(check.feature, "is no line");
        if (length_within(*line, grown(seen_, -mm_from_um(check.search_um))) < 30.0 * mm_per_px_)
            fail(check.feature, "is out of view");
    }
    void operator()(const EdgeDistanceCheck& check) const {
        for (const std::string& name : {check.feature_a, check.feature_b}) {
            if (name == "fiducial") continue;
            const Feature& feature = named(name);
            const auto* line = std::get_if<Line>(&feature.shape);
            const auto* pad = std::get_if<Pad>(&feature.shape);
            if (!line && !pad) fail(name, "has no straight edge: it must be a pad, a line or fiducial");
            if (line && length_within(*line, seen_) < 30.0 * mm_per_px_) fail(name, "is out of view");
            if (pad && !inside(square(pad->centre_mm, 0.0), seen_)) fail(name, "is out of view");
        }
        if (check.feature_a == check.feature_b) fail(check.feature_a, "is both of the two");
    }

  private:
    [[noreturn]] void fail(const std::string& feature, const std::string& problem) const {
        where_.fail(fmt::format(
            "site {}, view {}: {} {} (seen: x {:.2f} to {:.2f} mm, y {:.2f} to {:.2f} mm from the fiducial)",
            site_.tag_id, view_.name, feature, problem, seen_.low_mm.x() - site_.fiducial_mm.x(),
            seen_.high_mm.x() - site_.fiducial_mm.x(), seen_.low_mm.y() - site_.fiducial_mm.y(),
            seen_.high_mm.y() - site_.fiducial_mm.y()));
    }
    const Feature& named(const std::string& name) const {
        const Feature* feature = find_feature(plate_, name);
        if (!feature) fail(name, "is not among the plate's features");
        return *feature;
    }

    const YamlValue& where_;
    const Plate& plate_;
    const Site& site_;
    const View& view_;
    Box seen_;
    double mm_per_px_;
};

}  // namespace

bool tag_in_view(const CameraGeometry& camera, const PlateTag& tag, double s_mm) {
    return inside(square(tag.centre_mm, half_extent_mm(tag)), box_seen(camera, s_mm));
}

void check_fiducial_in_rows(const YamlValue& where, const Rig& rig, const PlateTag& tag) {
    const Box seen = box_seen(geometry_of(where, rig), tag.centre_mm.x());
    const double half_mm = half_extent_mm(tag);
    if (tag.centre_mm.y() - half_mm < seen.low_mm.y() || tag.centre_mm.y() + half_mm > seen.high_mm.y())
        where.fail(fmt::format(
            "fiducial {} lies at y = {:.2f} mm; the stage has one axis, so its row must be within "
            "{:.2f} to {:.2f} mm",
            tag.id, tag.centre_mm.y(), seen.low_mm.y() + half_mm, seen.high_mm.y() - half_mm));
}

void check_view(const YamlValue& where, const Rig& rig, const Plate& plate, const Site& site,
                const View& view) {
    const CameraGeometry& camera = geometry_of(where, rig);
    const double s_mm = site.fiducial_mm.x() + mm_from_um(view.offset_um);
    const CameraTravel travel = camera_travel(rig);
    if (s_mm < travel.low_mm || s_mm > travel.high_mm)
        where.fail(fmt::format(
            "site {}, view {}: the camera would be at {:.3f} mm; the stage reaches {:.1f} to {:.1f} mm",
            site.tag_id, view.name, s_mm, travel.low_mm, travel.high_mm));
    if (!tag_in_view(camera, *find_tag(plate, site.tag_id), s_mm))
        where.fail(fmt::format(
            "site {}, view {}: its fiducial is not wholly in view at {} um; every view must show it",
            site.tag_id, view.name, view.offset_um));
    const ViewChecker checker(where, camera, plate, site, view);
    for (const Check& check : view.checks) std::visit(checker, check);
}

void check_placement(const YamlValue& where, const Rig& rig, const Plate& plate, const Site& site) {
    const auto places = [](const Check& check) { return std::holds_alternative<PlacementCheck>(check); };
    const auto wanted = std::ranges::find_if(
        site.views, [&](const View& view) { return std::ranges::any_of(view.checks, places); });
    if (wanted == site.views.end()) return;
    const CameraGeometry& camera = geometry_of(where, rig);
    for (const View& view : site.views)
        for (const PlateTag& tag : plate.tags)
            if (tag.id != site.tag_id &&
                tag_in_view(camera, tag, site.fiducial_mm.x() + mm_from_um(view.offset_um)))
                return;
    where.fail(
        fmt::format("site {}, view {}: fiducial_placement needs another fiducial in one of the site's views",
                    site.tag_id, wanted->name));
}

}  // namespace fidservo::inspect
