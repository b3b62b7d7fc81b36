// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/edge_distance.h"

#include "core/failure.h"
#include "core/units.h"
#include "vision/features/straight_edge.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fidservo::vision {

namespace {

constexpr double edge_end_px = 5.0;  ///< left out at either end of an edge
constexpr double least_overlap_px = 8.0;
constexpr double opposed_within_rad = 0.1;

std::vector<NominalEdge> edges_of_rectangle(const Eigen::Vector2d& centre_mm, const Eigen::Vector2d& size_mm,
                                            double angle_rad) {
    const Eigen::Vector2d x(std::cos(angle_rad), std::sin(angle_rad));
    const Eigen::Vector2d y(-x.y(), x.x());
    std::vector<NominalEdge> edges;
    for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector2d side = centre_mm + 0.5 * sign * size_mm.x() * x;
        const Eigen::Vector2d top = centre_mm + 0.5 * sign * size_mm.y() * y;
        edges.push_back({side - 0.5 * size_mm.y() * y, side + 0.5 * size_mm.y() * y, sign * x});
        edges.push_back({top - 0.5 * size_mm.x() * x, top + 0.5 * size_mm.x() * x, sign * y});
    }
    return edges;
}

/// An interval of the coordinate along a direction on the plate, mm.
struct Interval {
    double low;
    double high;
    double length() const { return high - low; }
};

Interval extent_along(const NominalEdge& edge, const Eigen::Vector2d& direction) {
    const double a = edge.from_mm.dot(direction);
    const double b = edge.to_mm.dot(direction);
    return {std::min(a, b), std::max(a, b)};
}

Interval overlap_of(const NominalEdge& a, const NominalEdge& b, const Eigen::Vector2d& direction) {
    const Interval of_a = extent_along(a, direction);
    const Interval of_b = extent_along(b, direction);
    return {std::max(of_a.low, of_b.low), std::min(of_a.high, of_b.high)};
}

/// The distance from a to b if they face each other; infinity if they do not.
double facing_distance_mm(const NominalEdge& a, const NominalEdge& b) {
    constexpr double none = std::numeric_limits<double>::infinity();
    if (a.outward.dot(b.outward) > -std::cos(opposed_within_rad)) return none;
    const Eigen::Vector2d along = (a.to_mm - a.from_mm).normalized();
    if (overlap_of(a, b, along).length() <= 0.0) return none;
    const double gap = (0.5 * (b.from_mm + b.to_mm) - 0.5 * (a.from_mm + a.to_mm)).dot(a.outward);
    return gap > 0.0 ? gap : none;
}

/// The normal in the image of an edge that runs along `direction` there, away from the ink.
Eigen::Vector2d normal_towards(const RestImage& image, const Eigen::Vector2d& direction,
                               const NominalEdge& edge) {
    const Eigen::Vector2d middle_px = to_image(image, 0.5 * (edge.from_mm + edge.to_mm));
    const Eigen::Vector2d seen = picture_around(image, middle_px).image_by_plate * edge.outward;
    const Eigen::Vector2d normal(-direction.y(), direction.x());
    return normal.dot(seen) > 0.0 ? normal : Eigen::Vector2d(-normal);
}

/// The part of an edge within `overlap` (along `along`), in the image, its ends left out.
Result<StraightEdge> edge_in_image(const RestImage& image, const NominalEdge& edge,
                                   const Eigen::Vector2d& along, const Interval& overlap) {
    const Eigen::Vector2d own = (edge.to_mm - edge.from_mm).normalized();
    const double rate = own.dot(along);
    const double px = picture_around(image, to_image(image, 0.5 * (edge.from_mm + edge.to_mm))).mm_per_px;
    const Interval whole = extent_along(edge, along);
    const double low = std::max(overlap.low, whole.low + edge_end_px * px);
    const double high = std::min(overlap.high, whole.high - edge_end_px * px);
    const double start = edge.from_mm.dot(along);
    const Eigen::Vector2d from = to_image(image, edge.from_mm + own * ((low - start) / rate));
    const Eigen::Vector2d to = to_image(image, edge.from_mm + own * ((high - start) / rate));
    if (high - low < least_overlap_px * px)
        return failure(Reason::not_identifiable, fmt::format("the edges overlap by {:.0f} um only",
                                                             um_from_mm(std::max(0.0, high - low))));
    const Eigen::Vector2d far(image.grey.cols - 1.0, image.grey.rows - 1.0);
    if (from.cwiseMin(to).minCoeff() < fine_reach_px || (far - from.cwiseMax(to)).minCoeff() < fine_reach_px)
        return failure(Reason::not_identifiable, "an edge is partly outside the image");
    const Eigen::Vector2d direction = (to - from).normalized();
    return StraightEdge{0.5 * (from + to), direction, normal_towards(image, direction, edge),
                        (to - from).norm()};
}

/// A high quantile of the grey levels around an edge: the paper's level there.
double paper_grey_around(const cv::Mat& grey, const StraightEdge& edge, double reach_px) {
    std::vector<double> levels;
    for (const auto& section : edge.sections(grey, {reach_px, reach_px}))
        for (const EdgeSample& sample : section.samples) levels.push_back(sample.grey);
    if (levels.empty()) return 0.0;
    const auto high = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() * 3 / 4);
    std::nth_element(levels.begin(), high, levels.end());
    return *high;
}

/// @param reach_px  the edge lies this far from its nominal place at most, in this image
Result<OutlineFit<StraightEdge>> locate(const RestImage& image, StraightEdge edge, double reach_px,
                                        const SearchOptions& options) {
    const Eigen::Vector2d nominal_px = edge.middle_px;
    const double paper = paper_grey_around(image.grey, edge, reach_px + 4.0);
    if (const auto found = find_outline(image.grey, edge, reach_px + 4.0, paper, options); !found)
        return tl::make_unexpected(found.error());
    auto fit = fit_outline(image, edge, options);
    if (fit && (fit->shape.middle_px - nominal_px).norm() > 1.5 * reach_px)
        return failure(Reason::feature_not_found, "the only edge is beyond the search margin");
    return fit;
}

/// Where the line through an edge crosses the line through `at` along `direction`, as a distance from `at`,
/// and the standard deviation of that.
Measured crossing_px(const OutlineFit<StraightEdge>& edge, const Eigen::Vector2d& at,
                     const Eigen::Vector2d& direction) {
    const Eigen::Vector2d& normal = edge.shape.outward;
    const double distance = (edge.shape.middle_px - at).dot(normal) / direction.dot(normal);
    const double arm = (at + distance * direction - edge.shape.middle_px).dot(edge.shape.along);
    const double handed = edge.shape.along.x() * normal.y() - edge.shape.along.y() * normal.x();
    const Eigen::Vector2d row(1.0, handed * arm);
    return {distance, std::sqrt(row.dot(edge.covariance_px2 * row))};
}

/// The normal on the plate of an edge found in the image.
Eigen::Vector2d outward_on_plate(const RestImage& image, const StraightEdge& edge) {
    const Eigen::Matrix2d plate_by_image = picture_around(image, edge.middle_px).plate_by_image;
    const Eigen::Vector2d along = (plate_by_image * edge.along).normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    return normal.dot(plate_by_image * edge.outward) > 0.0 ? normal : Eigen::Vector2d(-normal);
}

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

}  // namespace

std::vector<NominalEdge> edges_of(const Pad& pad) {
    return edges_of_rectangle(pad.centre_mm, pad.size_mm, pad.angle_rad);
}

std::vector<NominalEdge> edges_of(const PlateTag& tag) {
    return edges_of_rectangle(tag.centre_mm, Eigen::Vector2d::Constant(tag.side_mm), tag.angle_rad);
}

std::vector<NominalEdge> edges_of(const Line& line) {
    const Eigen::Vector2d along = (line.to_mm - line.from_mm).normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    const Eigen::Vector2d half = 0.5 * line.width_mm * normal;
    return {{line.from_mm - half, line.to_mm - half, -normal},
            {line.from_mm + half, line.to_mm + half, normal}};
}

std::optional<std::pair<NominalEdge, NominalEdge>> facing_edges(const std::vector<NominalEdge>& a,
                                                                const std::vector<NominalEdge>& b) {
    std::optional<std::pair<NominalEdge, NominalEdge>> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (const NominalEdge& of_a : a)
        for (const NominalEdge& of_b : b) {
            const double distance = facing_distance_mm(of_a, of_b);
            if (distance >= least) continue;
            least = distance;
            nearest = {of_a, of_b};
        }
    return nearest;
}

Result<EdgeDistance> measure_edge_distance(const RestImage& image, const NominalEdge& a, const NominalEdge& b,
                                           const SearchOptions& options) {
    const Eigen::Vector2d along = (a.to_mm - a.from_mm).normalized();
    const Interval overlap = overlap_of(a, b, along);
    const auto edge_a = edge_in_image(image, a, along, overlap);
    if (!edge_a) return tl::make_unexpected(edge_a.error());
    const auto edge_b = edge_in_image(image, b, along, overlap);
    if (!edge_b) return tl::make_unexpected(edge_b.error());
    const double margin_px =
        options.margin_mm / picture_around(image, 0.5 * (edge_a->middle_px + edge_b->middle_px)).mm_per_px;
    const auto fit_a = locate(image, *edge_a, margin_px, options);
    if (!fit_a) return tl::make_unexpected(fit_a.error());
    const auto fit_b = locate(image, *edge_b, margin_px, options);
    if (!fit_b) return tl::make_unexpected(fit_b.error());

    const Eigen::Vector2d direction = (fit_a->shape.outward - fit_b->shape.outward).normalized();
    const Eigen::Vector2d between = 0.5 * (fit_a->shape.middle_px + fit_b->shape.middle_px);
    const Measured to_a = crossing_px(*fit_a, between, direction);
    const Measured to_b = crossing_px(*fit_b, between, direction);
    const Eigen::Vector2d on_a_mm = to_plate(image, between + to_a.value * direction);
    const Eigen::Vector2d on_b_mm = to_plate(image, between + to_b.value * direction);
    const Eigen::Vector2d outward_a = outward_on_plate(image, fit_a->shape);
    const Eigen::Vector2d outward_b = outward_on_plate(image, fit_b->shape);
    const double distance_um = um_from_mm((on_b_mm - on_a_mm).dot((outward_a - outward_b).normalized()));
    const double noise_um = std::hypot(to_a.std, to_b.std) *
                            um_from_mm(picture_around(image, between).mm_per_px_along(direction));
    const auto bend_um = [&](const StraightEdge& edge) {
        return bend_std_um(image, edge.middle_px, 0.5 * edge.length_px * edge.along);
    };
    const double bends_um = std::hypot(bend_um(fit_a->shape), bend_um(fit_b->shape));
    const double calibration_um =
        calibration_std_um(image, between + to_a.value * direction, between + to_b.value * direction);
    const double measured_um = std::hypot(noise_um, 2.0 * options.edge_allowance_um, bends_um);
    return EdgeDistance{{distance_um, std::hypot(measured_um, calibration_um)},
                        {angle_between(outward_a, -outward_b),
                         std::sqrt(fit_a->covariance_px2(1, 1) + fit_b->covariance_px2(1, 1))},
                        on_a_mm,
                        on_b_mm,
                        fit_a->quality,
                        fit_b->quality};
}

}  // namespace fidservo::vision
