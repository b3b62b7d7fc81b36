// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/checks.h"

#include "core/failure.h"
#include "core/result.h"
#include "core/units.h"
#include "src/inspect/measure/reference_check.h"
#include "src/inspect/recipe/clip.h"
#include "src/inspect/recipe/outline.h"
#include "src/inspect/recipe/placement.h"
#include "src/inspect/recipe/seen_box.h"
#include "vision/features/edge_distance.h"
#include "vision/features/line.h"
#include "vision/features/mark.h"
#include "vision/features/pad.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::inspect {
namespace {

using vision::Measured;

/// Makes the checks of one view and collects their rows.
class Checker {
  public:
    explicit Checker(const CheckContext& context)
        : context_(context),
          image_(context.snapshot.image),
          origin_um_(context.site.fiducial_mm * um_per_mm) {}

    CheckedView take() { return std::move(checked_); }

    void operator()(const PlacementCheck& check) {
        const std::string name = fmt::format("fiducial {}", context_.site.tag_id);
        const auto placement = measure_placement(context_.snapshots, context_.nominal, context_.site.tag_id);
        if (!placement) return add_failure("fiducial_placement", name, placement.error());
        ResultRow& x = add("fiducial_x", name, placement->x_um, 0.0, check.tolerance_um);
        explain(x, *placement, placement->disagreement_um.x());
        ResultRow& y = add("fiducial_y", name, placement->y_um, 0.0, check.tolerance_um);
        explain(y, *placement, placement->disagreement_um.y());
    }

    void operator()(const MarkCheck& check) {
        const Feature& feature = *find_feature(context_.nominal, check.feature);
        if (const auto* dot = std::get_if<Dot>(&feature.shape)) return check_dot(check, feature, *dot);
        check_pad(check, feature, std::get<Pad>(feature.shape));
    }

    void operator()(const LineCheck& check) {
        const Feature& feature = *find_feature(context_.nominal, check.feature);
        const Line& line = std::get<Line>(feature.shape);
        const auto found = vision::measure_line(image_, line, search(feature, check.search_um));
        if (!found) return add_missing("line_width", feature, found.error());
        const double nominal_um = um_from_mm(line.width_mm), least_um = nominal_um - check.width_tolerance_um;
        const Outcome width =
            add("line_width", feature.name, found->width_um, nominal_um, check.width_tolerance_um).verdict;
        ResultRow& narrowest =
            add("line_narrowest", feature.name, found->narrowest_um, nominal_um, check.width_tolerance_um);
        narrowest.verdict = outcome_of(vision::decide_at_least(found->narrowest_um, least_um));
        if (narrowest.verdict != Outcome::pass) {
            const Eigen::Vector2d at_um = found->narrowest_mm * um_per_mm - origin_um_;
            narrowest.reason =
                fmt::format("narrowest at x {:.0f}, y {:.0f} um from the fiducial", at_um.x(), at_um.y());
        }
        draw(rectangle(image_, {mm_from_um(found->x_um.value), mm_from_um(found->y_um.value)},
                       {mm_from_um(found->length_um), mm_from_um(found->width_um.value)},
                       found->angle_rad.value),
             worse(width, narrowest.verdict),
             fmt::format("{} {:.1f} \u00b5m", feature.name, found->width_um.value));
    }

    void operator()(const EdgeDistanceCheck& check) {
        const std::string name = check.feature_a + " to " + check.feature_b;
        const auto edges = vision::facing_edges(edges_in_view(check.feature_a, check.search_um),
                                                edges_in_view(check.feature_b, check.search_um));
        if (!edges)
            return add_failure("edge_distance", name,
                               {Reason::not_identifiable, "no two straight edges face each other"});
        const auto& [a, b] = *edges;
        const auto found = vision::measure_edge_distance(image_, a, b, search_between(check));
        if (!found) return add_failure("edge_distance", name, found.error());
        const double nominal_um =
            std::abs(((b.from_mm + b.to_mm) / 2 - (a.from_mm + a.to_mm) / 2).dot(a.outward)) * um_per_mm;
        const ResultRow& row = add("edge_distance", name, found->distance_um, nominal_um, check.tolerance_um);
        draw({to_image(image_, found->on_a_mm), to_image(image_, found->on_b_mm)}, row.verdict,
             fmt::format("{:.1f} \u00b5m", found->distance_um.value));
    }

    void operator()(const ReferenceCheck& check) {
        CheckedView compared = compare_view(context_, check);
        std::ranges::move(compared.rows, std::back_inserter(checked_.rows));
        std::ranges::move(compared.overlays, std::back_inserter(checked_.overlays));
    }

  private:
    void check_dot(const MarkCheck& check, const Feature& feature, const Dot& dot) {
        const auto found = vision::measure_dot(image_, dot, search(feature, check.search_um));
        if (!found) return add_missing("mark", feature, found.error());
        const Outcome place = add_centre(check, feature.name, found->x_um, found->y_um, dot.centre_mm);
        const Outcome size = add("mark_diameter", feature.name, found->diameter_um,
                                 um_from_mm(dot.diameter_mm), check.size_tolerance_um)
                                 .verdict;
        draw(circle(image_, {mm_from_um(found->x_um.value), mm_from_um(found->y_um.value)},
                    mm_from_um(found->diameter_um.value)),
             worse(place, size),
             fmt::format("{} \u2300 {:.1f} \u00b5m", feature.name, found->diameter_um.value));
    }

    void check_pad(const MarkCheck& check, const Feature& feature, const Pad& pad) {
        const auto found = vision::measure_pad(image_, pad, search(feature, check.search_um));
        if (!found) return add_missing("mark", feature, found.error());
        Outcome outcome = add_centre(check, feature.name, found->x_um, found->y_um, pad.centre_mm);
        outcome = worse(outcome, add("mark_width", feature.name, found->width_um, um_from_mm(pad.size_mm.x()),
                                     check.size_tolerance_um)
                                     .verdict);
        outcome = worse(outcome, add("mark_height", feature.name, found->height_um,
                                     um_from_mm(pad.size_mm.y()), check.size_tolerance_um)
                                     .verdict);
        draw(rectangle(image_, {mm_from_um(found->x_um.value), mm_from_um(found->y_um.value)},
                       {mm_from_um(found->width_um.value), mm_from_um(found->height_um.value)},
                       found->angle_rad.value),
             outcome, feature.name);
    }

    /// Centre rows are counted from the site's fiducial.
    Outcome add_centre(const MarkCheck& check, const std::string& name, const Measured& x_um,
                       const Measured& y_um, const Eigen::Vector2d& nominal_mm) {
        const Eigen::Vector2d nominal_um = nominal_mm * um_per_mm - origin_um_;
        const Outcome x = add("mark_centre_x", name, {x_um.value - origin_um_.x(), x_um.std}, nominal_um.x(),
                              check.centre_tolerance_um)
                              .verdict;
        return worse(x, add("mark_centre_y", name, {y_um.value - origin_um_.y(), y_um.std}, nominal_um.y(),
                            check.centre_tolerance_um)
                            .verdict);
    }

    ResultRow& add(std::string check, std::string feature, const Measured& measured, double nominal,
                   double tolerance) {
        checked_.rows.push_back({context_.site.tag_id, context_.view.name, std::move(check),
                                 std::move(feature), measured.value, "um", measured.std, nominal, tolerance,
                                 outcome_of(vision::decide(measured, nominal, tolerance)), "",
                                 context_.image});
        return checked_.rows.back();
    }

    void add_failure(std::string check, std::string feature, const Failure& why) {
        const Outcome outcome =
            why.reason == Reason::feature_not_found ? Outcome::fail : Outcome::not_decidable;
        checked_.rows.push_back({context_.site.tag_id,
                                 context_.view.name,
                                 std::move(check),
                                 std::move(feature),
                                 {},
                                 "um",
                                 {},
                                 {},
                                 {},
                                 outcome,
                                 fmt::format("{}: {}", name_of(why.reason), why.text),
                                 context_.image});
    }

    /// As above, and the nominal outline where it should have been.
    void add_missing(std::string check, const Feature& feature, const Failure& why) {
        add_failure(std::move(check), feature.name, why);
        draw(outline_of(image_, feature), checked_.rows.back().verdict,
             feature.name + ": " + std::string(name_of(why.reason)));
    }

    void explain(ResultRow& row, const Placement& placement, double disagreement_um) const {
        row.reason = fmt::format("against {} {}", placement.neighbours.size() == 1 ? "fiducial" : "fiducials",
                                 fmt::join(placement.neighbours, ", "));
        if (placement.neighbours.size() == 1) {
            if (row.verdict != Outcome::fail) return;
            row.verdict = Outcome::not_decidable;
            row.reason += ": which of the two is displaced cannot be told";
        } else if (row.verdict == Outcome::not_decidable) {
            row.reason += fmt::format(", which disagree by {:.1f} um", disagreement_um);
        }
    }

    void draw(Outline outline, Outcome outcome, std::string label) {
        const bool closed = outline.size() > 2;
        checked_.overlays.push_back(
            {Overlay::Kind::feature, outcome, closed, std::move(outline), std::move(label)});
    }

    vision::SearchOptions search(const Feature& feature, double search_um) const {
        vision::SearchOptions options;
        options.margin_mm = mm_from_um(search_um);
        options.expected_contrast = 1.0 - feature.reflectance / context_.nominal.paper_reflectance;
        return options;
    }

    vision::SearchOptions search_between(const EdgeDistanceCheck& check) const {
        for (const std::string& name : {check.feature_a, check.feature_b})
            if (const Feature* feature = find_feature(context_.nominal, name))
                return search(*feature, check.search_um);
        return {};
    }

    /// The parts of a feature's edges that are seen, with room to search.
    std::vector<vision::NominalEdge> edges_in_view(const std::string& name, double search_um) const {
        const CameraGeometry& camera = image_.camera.geometry;
        const double room_mm = mm_from_um(search_um) + 8.0 * mm_per_px(camera);
        const Eigen::Array2d room = Eigen::Array2d::Constant(room_mm);
        const Eigen::Vector2d aside(0.0, image_.axis_mm.y());
        const Box whole = box_seen(camera, image_.axis_mm.x());
        const Box seen{(whole.low_mm + aside).array() + room, (whole.high_mm + aside).array() - room};
        std::vector<vision::NominalEdge> parts;
        for (const vision::NominalEdge& edge : edges_named(name))
            if (const auto part = clipped(edge.from_mm, edge.to_mm, seen))
                parts.push_back({part->first, part->second, edge.outward});
        return parts;
    }

    std::vector<vision::NominalEdge> edges_named(const std::string& name) const {
        if (name == "fiducial") return vision::edges_of(*find_tag(context_.nominal, context_.site.tag_id));
        const Feature& feature = *find_feature(context_.nominal, name);
        if (const auto* pad = std::get_if<Pad>(&feature.shape)) return vision::edges_of(*pad);
        return vision::edges_of(std::get<Line>(feature.shape));
    }

    const CheckContext& context_;
    const vision::RestImage& image_;
    Eigen::Vector2d origin_um_;
    CheckedView checked_;
};

struct NameOfCheck {
    std::pair<std::string, std::string> operator()(const PlacementCheck&) const {
        return {"fiducial_placement", "fiducial"};
    }
    std::pair<std::string, std::string> operator()(const MarkCheck& check) const {
        return {"mark", check.feature};
    }
    std::pair<std::string, std::string> operator()(const LineCheck& check) const {
        return {"line_width", check.feature};
    }
    std::pair<std::string, std::string> operator()(const EdgeDistanceCheck& check) const {
        return {"edge_distance", check.feature_a + " to " + check.feature_b};
    }
    std::pair<std::string, std::string> operator()(const ReferenceCheck&) const {
        return {"reference", "view"};
    }
};

Overlay overlay_of(const vision::RefinedTag& tag, int own_id) {
    Overlay overlay{Overlay::Kind::fiducial, Outcome::pass, true, {}, std::to_string(tag.detection.tag_id)};
    overlay.points_px.assign(tag.detection.corners_px.begin(), tag.detection.corners_px.end());
    if (tag.detection.tag_id != own_id) overlay.label += " (neighbour)";
    return overlay;
}

}  // namespace

CheckedView check_view(const CheckContext& context) {
    Checker checker(context);
    for (const Check& check : context.view.checks) std::visit(checker, check);
    CheckedView checked = checker.take();
    for (const vision::RefinedTag& tag : context.snapshot.tags)
        checked.overlays.push_back(overlay_of(tag, context.site.tag_id));
    return checked;
}

std::vector<ResultRow> rows_not_measured(const Site& site, const View& view, const std::string& reason) {
    std::vector<ResultRow> rows;
    for (const Check& check : view.checks) {
        const auto [name, feature] = std::visit(NameOfCheck{}, check);
        rows.push_back(
            {site.tag_id, view.name, name, feature, {}, "um", {}, {}, {}, Outcome::not_measured, reason, ""});
    }
    return rows;
}

}  // namespace fidservo::inspect
