// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/stage/stage_map.h"

#include "calib/camera/pictured_corners.h"
#include "calib/camera/target_view.h"
#include "calib/dense.h"
#include "calib/significance.h"
#include "core/demand.h"
#include "core/failure.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

namespace fidservo::calib {

namespace {

constexpr std::size_t least_views = 4;
constexpr double least_share_of_width = 0.1;
constexpr double fit_tail = 1e-3;

/// Steps of the central differences: rounding and curvature both stay below 1e-9 of a derivative.
const MapNumbers difference_steps{{1e-4, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-4, 1e-4}};
constexpr double s_step_mm = 1e-4;

/// The camera that numbers stand for, and the plate's shift that lets it run through y = 0.
struct Posed {
    CameraGeometry camera;
    double y_mm;
};

Posed posed(const CameraGeometry& intrinsics, const MapNumbers& v, double middle_mm) {
    const double length = std::sqrt(1.0 + std::pow(v(map_axis_y), 2.0) + std::pow(v(map_axis_z), 2.0));
    CameraNumbers numbers = v.head<camera_numbers>();
    numbers(camera_distance) += middle_mm * v(map_axis_z) / length;
    return {with_numbers(intrinsics, numbers), v(map_y) - middle_mm * v(map_axis_y) / length};
}

std::array<Eigen::Vector2d, 4> shown_corners(const CameraGeometry& camera, const PlateTag& tag, double s_mm) {
    std::array<Eigen::Vector2d, 4> corners = vision::corners_mm(tag);
    for (Eigen::Vector2d& corner : corners) corner = project(camera, corner, s_mm);
    return corners;
}

Eigen::VectorXd expected_px(const Posed& posed, const StageView& view, double s_mm) {
    Eigen::VectorXd corners(static_cast<Eigen::Index>(8 * view.size()));
    Eigen::Index row = 0;
    for (const SeenTag& seen : view) {
        PlateTag tag = seen.nominal;
        tag.centre_mm.y() -= posed.y_mm;
        for (const Eigen::Vector2d& corner : seen.camera_known ? shown_corners(posed.camera, tag, s_mm)
                                                               : pictured_corners(posed.camera, tag, s_mm)) {
            corners.segment<2>(row) = corner;
            row += 2;
        }
    }
    return corners;
}

/// A view's residuals and derivatives.
struct Linearised {
    Eigen::VectorXd residual_px;  ///< seen minus expected
    Eigen::MatrixXd by_map;       ///< a column for each of MapNumbers
    Eigen::VectorXd by_s;
};

Eigen::VectorXd seen_px(const StageView& view) {
    Eigen::VectorXd seen(static_cast<Eigen::Index>(8 * view.size()));
    Eigen::Index row = 0;
    for (const SeenTag& tag : view)
        for (const Eigen::Vector2d& corner : tag.corners_px) {
            seen.segment<2>(row) = corner;
            row += 2;
        }
    return seen;
}

Linearised linearise(const CameraGeometry& intrinsics, const MapNumbers& values, double middle_mm,
                     const StageView& view, double s_mm) {
    const auto at = [&](const MapNumbers& v, double s) {
        return expected_px(posed(intrinsics, v, middle_mm), view, s);
    };
    Linearised out{seen_px(view) - at(values, s_mm), {}, {}};
    out.by_map.resize(out.residual_px.size(), map_values);
    for (int k = 0; k < map_values; ++k) {
        MapNumbers above = values, below = values;
        above(k) += difference_steps(k);
        below(k) -= difference_steps(k);
        out.by_map.col(k) = (at(above, s_mm) - at(below, s_mm)) / (2.0 * difference_steps(k));
    }
    out.by_s = (at(values, s_mm + s_step_mm) - at(values, s_mm - s_step_mm)) / (2.0 * s_step_mm);
    return out;
}

/// W with W C W^T = I, over all tags of a view, on what was measured of them.
Eigen::MatrixXd whitener(const StageView& view) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(8 * view.size()),
                                                 static_cast<Eigen::Index>(8 * view.size()));
    Eigen::Index used = 0;
    for (std::size_t k = 0; k < view.size(); ++k) {
        const CornerWeights weights = corner_weights(view[k].covariance_px2, 0.0);
        rows.block(used, static_cast<Eigen::Index>(8 * k), weights.rank, 8) =
            weights.whiten.topRows(weights.rank);
        used += weights.rank;
    }
    return rows.topRows(used);
}

/// The similarity that takes plate to image: where a fit begins, whatever the camera's rotation.
struct Similarity {
    double px_per_mm, rotation_rad;
    Eigen::Vector2d foot_mm;  ///< plate point at the principal point
};

Similarity similarity_of(const CameraGeometry& camera, const StageView& view) {
    Eigen::Vector2d plate_mean = Eigen::Vector2d::Zero(), image_mean = Eigen::Vector2d::Zero();
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;
    for (const SeenTag& tag : view) {
        const auto printed = vision::corners_mm(tag.nominal);
        for (std::size_t k = 0; k < 4; ++k) {
            pairs.emplace_back(printed[k], tag.corners_px[k]);
            plate_mean += pairs.back().first;
            image_mean += pairs.back().second;
        }
    }
    plate_mean /= static_cast<double>(pairs.size());
    image_mean /= static_cast<double>(pairs.size());
    double along = 0.0, across = 0.0, spread = 0.0;
    for (const auto& [plate, image] : pairs) {
        const Eigen::Vector2d p = plate - plate_mean, q = image - image_mean;
        along += p.dot(q);
        across += p.x() * q.y() - p.y() * q.x();
        spread += p.squaredNorm();
    }
    Similarity fit{std::hypot(along, across) / spread, std::atan2(across, along), {}};
    fit.foot_mm = plate_mean + Eigen::Rotation2Dd(-fit.rotation_rad) *
                                   (camera.principal_point_px - image_mean) / fit.px_per_mm;
    return fit;
}

struct Start {
    MapNumbers values = MapNumbers::Zero();
    std::vector<double> s_mm;
    double middle_mm = 0.0;
};

Start start_of(const CameraGeometry& camera, std::span<const StageView> views) {
    Start start;
    std::vector<double> y_mm;
    double scale = 0.0, sine = 0.0, cosine = 0.0;
    for (const StageView& view : views) {
        const Similarity fit = similarity_of(camera, view);
        start.s_mm.push_back(fit.foot_mm.x());
        y_mm.push_back(fit.foot_mm.y());
        scale += fit.px_per_mm;
        sine += std::sin(fit.rotation_rad);
        cosine += std::cos(fit.rotation_rad);
    }
    const auto n = static_cast<double>(views.size());
    start.middle_mm = std::accumulate(start.s_mm.begin(), start.s_mm.end(), 0.0) / n;
    const double y_mean = std::accumulate(y_mm.begin(), y_mm.end(), 0.0) / n;
    double products = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const double way = start.s_mm[i] - start.middle_mm;
        products += way * (y_mm[i] - y_mean);
        squares += way * way;
    }
    start.values(map_distance) = camera.focal_px / (scale / n);
    start.values(map_rotation) = std::atan2(sine, cosine);
    start.values(map_axis_y) = squares > 0.0 ? products / squares : 0.0;
    start.values(map_k1) = camera.distortion.k1;
    start.values(map_y) = y_mean;
    return start;
}

/// The normal equations with all positions eliminated.
struct Normal {
    MapCovariance matrix = MapCovariance::Zero();
    MapNumbers right = MapNumbers::Zero();
    std::vector<MapNumbers> coupling;  ///< of each position with the map
    std::vector<double> own, own_right;
    double squares = 0.0;
    Eigen::Index measured = 0;  ///< independent numbers that went in
};

Normal normal_of(const CameraGeometry& camera, const Start& at, std::span<const StageView> views) {
    Normal normal;
    for (std::size_t i = 0; i < views.size(); ++i) {
        Linearised view = linearise(camera, at.values, at.middle_mm, views[i], at.s_mm[i]);
        const Eigen::MatrixXd white = whitener(views[i]);
        view.residual_px = product(white, view.residual_px);
        view.by_map = product(white, view.by_map);
        view.by_s = product(white, view.by_s);
        const Eigen::MatrixXd transposed = view.by_map.transpose();
        normal.measured += white.rows();
        normal.coupling.emplace_back(product(transposed, view.by_s));
        normal.own.push_back(view.by_s.squaredNorm());
        normal.own_right.push_back(view.by_s.dot(view.residual_px));
        const MapNumbers& c = normal.coupling.back();
        normal.matrix += product(transposed, view.by_map) - product(c, c.transpose()) / normal.own.back();
        normal.right +=
            product(transposed, view.residual_px) - c * normal.own_right.back() / normal.own.back();
        normal.squares += view.residual_px.squaredNorm();
    }
    return normal;
}

/// Fails if some combination of the numbers is not determined.
Result<MapCovariance> inverse_of(const MapCovariance& matrix) {
    constexpr double least_eigenvalue = 1e-11;
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scales = product(scale, scale.transpose());
    const Eigen::MatrixXd scaled = matrix.cwiseProduct(scales);
    if (!scaled.allFinite() || symmetric_parts(scaled).values(0) < least_eigenvalue)
        return failure(Reason::not_identifiable,
                       "the views leave a combination of the camera's numbers undetermined");
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(map_values, map_values);
    const Eigen::MatrixXd inverse = scaled.ldlt().solve(identity);
    return MapCovariance(inverse.cwiseProduct(scales));
}

Status demand_variety(const CameraGeometry& camera, std::span<const StageView> views, const Start& start) {
    if (views.size() < least_views)
        return failure(Reason::not_identifiable,
                       fmt::format("{} views: {} are needed", views.size(), least_views));
    const auto [low, high] = std::ranges::minmax(start.s_mm);
    const double width_mm = camera.width_px * start.values(map_distance) / camera.focal_px;
    if (high - low < least_share_of_width * width_mm)
        return failure(Reason::not_identifiable,
                       fmt::format("the camera moved over {:.3g} mm only: the stage's axis needs {:.3g} mm",
                                   high - low, least_share_of_width * width_mm));
    double left = camera.width_px, right = 0.0;
    for (const StageView& view : views)
        for (const SeenTag& tag : view)
            for (const Eigen::Vector2d& corner : tag.corners_px) {
                left = std::min(left, corner.x());
                right = std::max(right, corner.x());
            }
    if (right - left < least_share_of_width * camera.width_px)
        return failure(Reason::not_identifiable, "the tags fill less than a tenth of the image's width");
    return {};
}

}  // namespace

double StageMap::image_axis_std_rad() const {
    return std::sqrt(covariance(map_rotation, map_rotation) + covariance(map_axis_y, map_axis_y) +
                     2.0 * covariance(map_rotation, map_axis_y));
}

Result<StageMap> fit_stage_map(const CameraGeometry& nominal, std::span<const StageView> views) {
    FIDSERVO_DEMAND(std::ranges::none_of(views, &StageView::empty));
    Start at = start_of(nominal, views);
    if (auto varied = demand_variety(nominal, views, at); !varied) return tl::make_unexpected(varied.error());

    constexpr int most_steps = 20;
    constexpr double enough = 1e-4;  // of a standard deviation
    Normal normal = normal_of(nominal, at, views);
    MapCovariance covariance;
    bool converged = false;
    for (int step = 0; step < most_steps && !converged; ++step) {
        const auto inverse = inverse_of(normal.matrix);
        if (!inverse) return tl::make_unexpected(inverse.error());
        covariance = *inverse;
        const MapNumbers change = product(covariance, normal.right);
        at.values += change;
        for (std::size_t i = 0; i < views.size(); ++i)
            at.s_mm[i] += (normal.own_right[i] - normal.coupling[i].dot(change)) / normal.own[i];
        converged = change.cwiseAbs().cwiseQuotient(covariance.diagonal().cwiseSqrt()).maxCoeff() < enough;
        normal = normal_of(nominal, at, views);
        if (!std::isfinite(normal.squares)) break;
    }
    if (!converged) return failure(Reason::no_convergence, "the camera-to-stage map's iteration did not end");

    StageMap map;
    const Posed pose = posed(nominal, at.values, at.middle_mm);
    map.camera = pose.camera;
    map.middle_mm = at.middle_mm;
    map.values = at.values;
    map.s_mm = at.s_mm;
    std::size_t coordinates = 0;
    double squares_px2 = 0.0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        coordinates += 8 * views[i].size();
        squares_px2 += (seen_px(views[i]) - expected_px(pose, views[i], at.s_mm[i])).squaredNorm();
    }
    map.freedom = static_cast<double>(normal.measured) - map_values - static_cast<double>(views.size());
    map.misfit = normal.squares / map.freedom;
    map.fits = normal.squares <= chi_square_bound(map.freedom, fit_tail);
    map.residual_rms_px = std::sqrt(squares_px2 / static_cast<double>(coordinates));
    const double widening = map.fits ? 1.0 : map.misfit;
    map.covariance = widening * covariance;
    for (std::size_t i = 0; i < views.size(); ++i)
        map.s_std_mm.push_back(std::sqrt(widening / normal.own[i] +
                                         propagated(map.covariance, normal.coupling[i].transpose())(0, 0) /
                                             (normal.own[i] * normal.own[i])));
    auto camera_by_map = Eigen::Matrix<double, camera_numbers, map_values>::Identity().eval();
    camera_by_map(camera_distance, map_axis_z) = at.middle_mm;
    map.camera_covariance = propagated(map.covariance, camera_by_map);
    return map;
}

ViewCheck check_view(const StageMap& map, const StageView& view) {
    FIDSERVO_DEMAND(!view.empty());
    constexpr int steps = 5;
    const Eigen::MatrixXd white = whitener(view);
    double s_mm = similarity_of(map.camera, view).foot_mm.x();
    Linearised at = linearise(map.camera, map.values, map.middle_mm, view, s_mm);
    for (int step = 0; step < steps; ++step) {
        const Eigen::VectorXd by_s = product(white, at.by_s), residual = product(white, at.residual_px);
        s_mm += by_s.dot(residual) / by_s.squaredNorm();
        at = linearise(map.camera, map.values, map.middle_mm, view, s_mm);
    }
    const Eigen::VectorXd residual = product(white, at.residual_px), by_s = product(white, at.by_s);
    const double widening = map.fits ? 1.0 : map.misfit;
    const Eigen::MatrixXd covariance = widening * Eigen::MatrixXd::Identity(white.rows(), white.rows()) +
                                       propagated(map.covariance, product(white, at.by_map));
    const Eigen::LDLT<Eigen::MatrixXd> root(covariance);
    const Eigen::VectorXd residual_weighed = root.solve(residual), by_s_weighed = root.solve(by_s);
    const double along = by_s.dot(residual_weighed), own = by_s.dot(by_s_weighed);

    // What the fit of s leaves of noise and of the map's errors, in px.
    const Eigen::MatrixXd gain = product(by_s.transpose(), white) / by_s.squaredNorm();
    const Eigen::MatrixXd leave =
        Eigen::MatrixXd::Identity(at.by_s.size(), at.by_s.size()) - product(at.by_s, gain);
    Eigen::MatrixXd errors = propagated(map.covariance, at.by_map);
    for (std::size_t k = 0; k < view.size(); ++k)
        errors.block<8, 8>(static_cast<Eigen::Index>(8 * k), static_cast<Eigen::Index>(8 * k)) +=
            widening * view[k].covariance_px2;
    const Eigen::MatrixXd left = propagated(errors, leave);
    ViewCheck check{};
    check.s_mm = s_mm;
    check.s_std_mm = std::sqrt(propagated(errors, gain)(0, 0));
    check.chi_square = residual.dot(residual_weighed) - along * along / own;
    check.freedom = static_cast<double>(residual.size()) - 1.0;
    const auto n = static_cast<double>(at.residual_px.size());
    check.rms_px = std::sqrt(at.residual_px.squaredNorm() / n);
    check.promised_rms_px = std::sqrt(left.trace() / n);
    const Eigen::VectorXd normalised =
        at.residual_px.cwiseAbs().cwiseQuotient(left.diagonal().cwiseMax(1e-12).cwiseSqrt());
    Eigen::Index worst = 0;
    check.worst_normalised = normalised.maxCoeff(&worst);
    check.worst_px = std::abs(at.residual_px(worst));
    return check;
}

std::vector<std::array<Eigen::Vector2d, 4>> residuals_px(const StageMap& map, const StageView& view,
                                                         double s_mm) {
    const Eigen::VectorXd left =
        seen_px(view) - expected_px(posed(map.camera, map.values, map.middle_mm), view, s_mm);
    std::vector<std::array<Eigen::Vector2d, 4>> residuals(view.size());
    for (std::size_t k = 0; k < view.size(); ++k)
        for (std::size_t c = 0; c < 4; ++c)
            residuals[k][c] = left.segment<2>(static_cast<Eigen::Index>(8 * k + 2 * c));
    return residuals;
}

}  // namespace fidservo::calib
