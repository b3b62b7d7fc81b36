// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/mark.h"

#include "core/failure.h"
#include "core/units.h"
#include "vision/features/coarse_search.h"
#include "vision/features/normal_law.h"
#include "vision/features/outline_fit.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace fidservo::vision {

namespace {

constexpr double sector_px = 4.0;  ///< arc of a sector
constexpr double least_radius_px = 6.0;

/// Parameters: centre x, centre y, radius, px.
struct Circle {
    static constexpr int parameters = 3;
    Eigen::Vector2d centre_px;
    double radius_px;

    std::vector<OutlineSection<parameters>> sections(const cv::Mat& grey, const Reach& reach) const {
        const double round = 2.0 * std::numbers::pi;
        const int count = std::max(12, static_cast<int>(round * radius_px / sector_px));
        const double inwards = std::min(reach.in_px, 0.9 * radius_px);
        auto samples = samples_of_ring(grey, centre_px, radius_px, {inwards, reach.out_px}, count);
        std::vector<OutlineSection<parameters>> found;
        found.reserve(count);
        for (int k = 0; k < count; ++k)
            found.push_back(
                {std::move(samples[k]), {std::cos(round * k / count), std::sin(round * k / count), 1.0}});
        return found;
    }

    void correct(const Eigen::Vector3d& correction) {
        centre_px += correction.head<2>();
        radius_px = std::max(1.0, radius_px + correction[2]);
    }
};

/// How far blur moves the half-way level of a disc's edge towards its centre.
double curvature_shift_px(double radius_px, double sigma_px) {
    return sigma_px * sigma_px / (2.0 * radius_px);
}

Status check_mark(const RestImage& image, const Circle& circle, const Eigen::Vector2d& nominal_px,
                  const SearchOptions& options) {
    const Eigen::Vector2d far = image.grey.cols > 0
                                    ? Eigen::Vector2d(image.grey.cols - 1.0, image.grey.rows - 1.0)
                                    : Eigen::Vector2d::Zero();
    const double outer = circle.radius_px + fine_reach_px;
    if ((circle.centre_px.array() - outer).minCoeff() < 0.0 || (far - circle.centre_px).minCoeff() < outer)
        return failure(Reason::not_identifiable, "the dot is partly outside the image");
    if (circle.radius_px < least_radius_px)
        return failure(Reason::not_identifiable,
                       fmt::format("a dot of {:.1f} px radius is too small; {:.0f} px are needed",
                                   circle.radius_px, least_radius_px));
    const double away_mm = (to_plate(image, circle.centre_px) - to_plate(image, nominal_px)).norm();
    if (away_mm > 1.5 * options.margin_mm)
        return failure(
            Reason::feature_not_found,
            fmt::format("the only candidate is {:.0f} um away, beyond the margin", um_from_mm(away_mm)));
    return {};
}

}  // namespace

Result<DotMeasurement> measure_dot(const RestImage& image, const Dot& nominal, const SearchOptions& options) {
    const Eigen::Vector2d nominal_px = to_image(image, nominal.centre_mm);
    const double nominal_mm_per_px = picture_around(image, nominal_px).mm_per_px;
    const double nominal_radius_px = 0.5 * nominal.diameter_mm / nominal_mm_per_px;
    const auto coverage = [&](double x, double y) {
        return normal_cdf((nominal_radius_px - std::hypot(x, y)) / edge_sigma_px(image.camera.blur_px));
    };
    const auto match =
        find_shape(image, nominal_px, Eigen::Vector2d::Constant(nominal_radius_px), coverage, options);
    if (!match) return tl::make_unexpected(match.error());

    Circle circle{match->centre_px, nominal_radius_px};
    const double reach_px = std::min(options.margin_mm / nominal_mm_per_px, 0.6 * nominal_radius_px) + 4.0;
    if (const auto found = find_outline(image.grey, circle, reach_px, match->paper_grey, options); !found)
        return tl::make_unexpected(found.error());
    auto fit = fit_outline(image, circle, options);
    if (!fit) return tl::make_unexpected(fit.error());
    if (const auto good = check_mark(image, fit->shape, nominal_px, options); !good)
        return tl::make_unexpected(good.error());

    const double seen_px = fit->shape.radius_px;
    const double radius_px = seen_px + curvature_shift_px(seen_px, edge_sigma_px(fit->quality.blur_px));
    const Eigen::Vector2d& centre_px = fit->shape.centre_px;
    const double um_per_px = um_from_mm(picture_around(image, centre_px).mm_per_px);
    const double radius_std_um = std::sqrt(fit->covariance_px2(2, 2)) * um_per_px;
    const double bend_um = bend_std_um(image, centre_px, Eigen::Vector2d::Constant(fit->shape.radius_px));
    const auto [x_um, y_um] = place_um(image, centre_px, fit->covariance_px2.topLeftCorner<2, 2>(), bend_um);
    const Eigen::Vector2d arm(fit->shape.radius_px, 0.0);
    const double edges_um = 2.0 * std::hypot(radius_std_um, options.edge_allowance_um, bend_um);
    return DotMeasurement{x_um,
                          y_um,
                          {2.0 * radius_px * um_per_px,
                           std::hypot(edges_um, calibration_std_um(image, centre_px - arm, centre_px + arm))},
                          fit->quality};
}

}  // namespace fidservo::vision
