// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/pad.h"

#include "core/failure.h"
#include "core/units.h"
#include "vision/features/coarse_search.h"
#include "vision/features/normal_law.h"
#include "vision/features/outline_fit.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::vision {

namespace {

constexpr double pad_section_px = 6.0;
constexpr double corner_reach_px =
    5.0;  ///< of each side, left out at either end: the corner's blur reaches that far
constexpr double least_side_px = 16.0;

/// Parameters: centre x, centre y, width, height in px, angle in rad.
struct Rectangle {
    static constexpr int parameters = 5;
    Eigen::Vector2d centre_px;
    Eigen::Vector2d size_px;
    double angle_rad;

    std::vector<OutlineSection<parameters>> sections(const cv::Mat& grey, const Reach& reach) const {
        std::vector<OutlineSection<parameters>> found;
        for (int axis = 0; axis < 2; ++axis)
            for (const double sign : {-1.0, 1.0}) add_side(grey, reach, axis, sign, found);
        return found;
    }

    void correct(const Eigen::Matrix<double, parameters, 1>& correction) {
        centre_px += correction.head<2>();
        size_px = (size_px + correction.segment<2>(2)).cwiseMax(2.0);
        angle_rad += correction[4];
    }

    /// The pad's own x (0) or y (1) direction in the image.
    Eigen::Vector2d direction(int axis) const {
        return axis == 0 ? Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad))
                         : Eigen::Vector2d(-std::sin(angle_rad), std::cos(angle_rad));
    }

  private:
    /// The side whose outward normal is `sign` times the pad's axis.
    void add_side(const cv::Mat& grey, const Reach& reach, int axis, double sign,
                  std::vector<OutlineSection<parameters>>& found) const {
        const Eigen::Vector2d normal = sign * direction(axis);
        const Eigen::Vector2d along = direction(1 - axis);
        const double length = std::max(pad_section_px, size_px[1 - axis] - 2.0 * corner_reach_px);
        const int count = static_cast<int>(std::ceil(length / pad_section_px));
        const Eigen::Vector2d middle = centre_px + 0.5 * size_px[axis] * normal;
        const Eigen::Vector2d from = middle - 0.5 * length * along;
        const double inwards = std::min(reach.in_px, 0.45 * size_px[axis]);
        auto samples =
            samples_of_band(grey, from, from + length * along, normal, {inwards, reach.out_px}, count);
        for (int k = 0; k < count; ++k) {
            const Eigen::Vector2d arm = from + (k + 0.5) * length / count * along - centre_px;
            OutlineSection<parameters> section{std::move(samples[k]), {}};
            section.row << normal.x(), normal.y(), 0.0, 0.0, normal.dot(Eigen::Vector2d(-arm.y(), arm.x()));
            section.row[2 + axis] = 0.5;
            found.push_back(std::move(section));
        }
    }
};

double angle_of(const Eigen::Vector2d& direction) {
    return std::atan2(direction.y(), direction.x());
}

bool within_image(const cv::Mat& grey, const Rectangle& pad) {
    const Eigen::Vector2d far(grey.cols - 1.0, grey.rows - 1.0);
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5}) {
            const Eigen::Vector2d corner = pad.centre_px + x * pad.size_px.x() * pad.direction(0) +
                                           y * pad.size_px.y() * pad.direction(1);
            if (corner.minCoeff() < fine_reach_px || (far - corner).minCoeff() < fine_reach_px) return false;
        }
    return true;
}

Status check_pad(const RestImage& image, const Rectangle& pad, const Eigen::Vector2d& nominal_px,
                 const SearchOptions& options) {
    if (!within_image(image.grey, pad))
        return failure(Reason::not_identifiable, "the pad is partly outside the image");
    if (pad.size_px.minCoeff() < least_side_px)
        return failure(Reason::not_identifiable,
                       fmt::format("a side of {:.1f} px is too short; {:.0f} px are needed",
                                   pad.size_px.minCoeff(), least_side_px));
    const double away_mm = (to_plate(image, pad.centre_px) - to_plate(image, nominal_px)).norm();
    if (away_mm > 1.5 * options.margin_mm)
        return failure(
            Reason::feature_not_found,
            fmt::format("the only candidate is {:.0f} um away, beyond the margin", um_from_mm(away_mm)));
    return {};
}

Result<Rectangle> find_rectangle(const RestImage& image, const Pad& nominal, const SearchOptions& options) {
    const Eigen::Vector2d nominal_px = to_image(image, nominal.centre_mm);
    const LocalPicture picture = picture_around(image, nominal_px);
    const Eigen::Vector2d own_x(std::cos(nominal.angle_rad), std::sin(nominal.angle_rad));
    const Eigen::Vector2d own_y(-own_x.y(), own_x.x());
    const Eigen::Vector2d half = 0.5 * nominal.size_mm.cwiseProduct(Eigen::Vector2d(
                                           picture.px_per_mm_along(own_x), picture.px_per_mm_along(own_y)));
    const double angle_rad = angle_of(picture.image_by_plate * own_x);
    const double c = std::cos(angle_rad);
    const double s = std::sin(angle_rad);
    const double sigma = edge_sigma_px(image.camera.blur_px);
    const auto between = [&](double x, double a) {
        return normal_cdf((x + a) / sigma) - normal_cdf((x - a) / sigma);
    };
    const auto coverage = [&](double x, double y) {
        return between(c * x + s * y, half.x()) * between(c * y - s * x, half.y());
    };
    const Eigen::Vector2d box(std::abs(c) * half.x() + std::abs(s) * half.y(),
                              std::abs(s) * half.x() + std::abs(c) * half.y());
    const auto match = find_shape(image, nominal_px, box, coverage, options);
    if (!match) return tl::make_unexpected(match.error());
    Rectangle pad{match->centre_px, 2.0 * half, angle_rad};
    const double reach_px = std::min(options.margin_mm / picture.mm_per_px, 0.6 * half.minCoeff()) + 4.0;
    if (const auto found = find_outline(image.grey, pad, reach_px, match->paper_grey, options); !found)
        return tl::make_unexpected(found.error());
    return pad;
}

}  // namespace

Result<PadMeasurement> measure_pad(const RestImage& image, const Pad& nominal, const SearchOptions& options) {
    const auto start = find_rectangle(image, nominal, options);
    if (!start) return tl::make_unexpected(start.error());
    const auto fit = fit_outline(image, *start, options);
    if (!fit) return tl::make_unexpected(fit.error());
    const Rectangle& pad = fit->shape;
    if (const auto good = check_pad(image, pad, to_image(image, nominal.centre_mm), options); !good)
        return tl::make_unexpected(good.error());

    const LocalPicture picture = picture_around(image, pad.centre_px);
    const Eigen::Vector2d um_per_px(um_from_mm(picture.mm_per_px_along(pad.direction(0))),
                                    um_from_mm(picture.mm_per_px_along(pad.direction(1))));
    const Eigen::Matrix<double, 5, 1> std = fit->covariance_px2.diagonal().cwiseSqrt();
    const double both_edges_um = 2.0 * options.edge_allowance_um;
    const double bend_um = bend_std_um(image, pad.centre_px, 0.5 * pad.size_px);
    const Eigen::Vector2d size_um = pad.size_px.cwiseProduct(um_per_px);
    const Eigen::Vector2d size_std_um = std.segment<2>(2).cwiseProduct(um_per_px);
    const auto [x_um, y_um] =
        place_um(image, pad.centre_px, fit->covariance_px2.topLeftCorner<2, 2>(), bend_um);
    const auto size = [&](int side) {
        const Eigen::Vector2d arm = 0.5 * pad.size_px(side) * pad.direction(side);
        const double calibration_um = calibration_std_um(image, pad.centre_px - arm, pad.centre_px + arm);
        return Measured{size_um(side),
                        std::hypot(std::hypot(size_std_um(side), both_edges_um), bend_um, calibration_um)};
    };
    return PadMeasurement{x_um,
                          y_um,
                          size(0),
                          size(1),
                          {angle_of(picture.plate_by_image * pad.direction(0)),
                           std::hypot(std[4], bend_um / size_um.maxCoeff())},
                          fit->quality};
}

}  // namespace fidservo::vision
