// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/camera_position.h"

#include "core/camera/camera_slopes.h"
#include "core/failure.h"
#include "vision/tags/quad.h"
#include "vision/tags/tag_choice.h"
#include "vision/tags/tag_pattern.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

constexpr unsigned char saturated_level = 255;

/// First and last column of a row whose pixels lie inside a convex outline; first > last: none.
struct Columns {
    int first, last;
};

Columns columns_inside(const std::array<Eigen::Vector2d, 4>& corners_px, int row, int width) {
    double low = 0.0, high = width - 1.0;
    const Eigen::Vector2d middle = 0.25 * (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3]);
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d side = corners_px[(k + 1) % 4] - corners_px[k];
        Eigen::Vector2d inwards(-side.y(), side.x());
        if (inwards.dot(middle - corners_px[k]) < 0) inwards = -inwards;
        // inwards . ((u, row) - corner) >= 0
        const double at_zero = inwards.y() * (row - corners_px[k].y()) - inwards.x() * corners_px[k].x();
        if (inwards.x() > 0)
            low = std::max(low, -at_zero / inwards.x());
        else if (inwards.x() < 0)
            high = std::min(high, -at_zero / inwards.x());
        else if (at_zero < 0)
            return {0, -1};
    }
    if (!(low <= high)) return {0, -1};
    return {static_cast<int>(std::ceil(low)), static_cast<int>(std::floor(high))};
}

/// Share of saturated pixels among those inside the outline.
double saturated_share(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px) {
    double top = corners_px[0].y(), bottom = top;
    for (const Eigen::Vector2d& corner : corners_px) {
        top = std::min(top, corner.y());
        bottom = std::max(bottom, corner.y());
    }
    if (!(top < image.rows && bottom >= 0)) return 0.0;
    const int first_row = static_cast<int>(std::ceil(std::max(0.0, top)));
    const int last_row = static_cast<int>(std::floor(std::min(image.rows - 1.0, bottom)));
    std::ptrdiff_t saturated = 0;
    std::ptrdiff_t pixels = 0;
    for (int row = first_row; row <= last_row; ++row) {
        const auto [first, last] = columns_inside(corners_px, row, image.cols);
        if (first > last) continue;
        const auto* grey = image.ptr<unsigned char>(row);
        saturated += std::count(grey + first, grey + last + 1, saturated_level);
        pixels += last - first + 1;
    }
    return pixels > 0 ? static_cast<double>(saturated) / static_cast<double>(pixels) : 0.0;
}

double saturated_share(const cv::Mat& image) {
    return cv::countNonZero(image == saturated_level) / static_cast<double>(image.total());
}

/// Camera position by any tag of the plate that was read; else what the stage believes.
std::optional<double> rough_position(const CameraGeometry& camera, const Plate& nominal,
                                     const std::vector<TagDetection>& found, const LocateOptions& options) {
    for (const TagDetection& tag : found)
        if (const std::optional<PlateTag> known = find_tag(nominal, tag.tag_id))
            return fit_position(camera, *known, unrefined(tag)).position.s_mm;
    return options.predicted_s_mm;
}

/// Why the expected tag is not among those found.
Failure explain_absence(const CameraGeometry& camera, const Plate& nominal, const cv::Mat& image,
                        const std::vector<TagDetection>& found, const PlateTag& expected,
                        const LocateOptions& options) {
    constexpr double partly_seen = 0.3;  // of the pattern; bare plate explains nothing
    if (const auto s_mm = rough_position(camera, nominal, found, options)) {
        std::array<Eigen::Vector2d, 4> place_px;
        for (std::size_t k = 0; k < 4; ++k) place_px[k] = project(camera, corners_mm(expected)[k], *s_mm);
        const double side_px =
            expected.side_mm / mm_per_px_at(camera, project(camera, expected.centre_mm, *s_mm), *s_mm);
        const bool another_is_there = std::any_of(found.begin(), found.end(), [&](const TagDetection& tag) {
            return (centre_of(tag.corners_px) - centre_of(place_px)).norm() < 0.5 * side_px;
        });
        if (const double share = saturated_share(image, place_px); share > options.most_saturated)
            return {Reason::glare, fmt::format("{:.1f} % of tag {} is saturated", 100 * share, expected.id)};
        if (!another_is_there &&
            explained_contrast(image, place_px, tag_pattern(expected.print, expected.id)) > partly_seen)
            return {Reason::occluded,
                    fmt::format("tag {} is there, but too much of it is hidden", expected.id)};
    }
    if (const double share = saturated_share(image); share > options.most_saturated)
        return {Reason::glare, fmt::format("tag {} is not seen and {:.0f} % of the image is saturated",
                                           expected.id, 100 * share)};
    if (found.empty())
        return {Reason::no_tag, fmt::format("no tag in view, tag {} is expected", expected.id)};
    std::vector<std::string> seen;
    seen.reserve(found.size());
    for (const TagDetection& tag : found)
        seen.push_back(
            fmt::format("{}{}", tag.tag_id, find_tag(nominal, tag.tag_id) ? "" : " (not on the plate)"));
    return {Reason::wrong_tag,
            fmt::format("tag {} is expected, seen: {}", expected.id, fmt::join(seen, ", "))};
}

/// Image of the tag's centre by its corners, where neither tilt nor distortion shifts it.
Eigen::Vector2d centre_by_corners(const CameraGeometry& camera, const TagDetection& tag) {
    Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : tag.corners_px)
        centre_mm += 0.25 * back_project(camera, corner, 0.0);
    return project(camera, centre_mm, 0.0);
}

/// How a tag is turned where it lies.
struct TagTurn {
    double angle_rad, std_rad, residual_rms_px;
};

/// @param camera_mm  s and y
TagTurn turn_of(const CameraGeometry& camera, const PlateTag& nominal, const RefinedTag& seen,
                const Eigen::Vector2d& camera_mm) {
    const std::array<Eigen::Vector2d, 4> corners = corners_mm(nominal);
    const Eigen::Vector2d aside(0.0, camera_mm.y());
    const double s_mm = camera_mm.x();
    double along = 0.0, across = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d arm = corners[k] - nominal.centre_mm;
        const Eigen::Vector2d found =
            back_project(camera, seen.detection.corners_px[k], s_mm) + aside - nominal.centre_mm;
        along += arm.dot(found);
        across += arm.x() * found.y() - arm.y() * found.x();
    }
    const double angle_rad = std::atan2(across, along);
    const Eigen::Rotation2Dd turn(angle_rad);
    Eigen::Matrix<double, 1, 8> angle_by_image;
    double squares_px2 = 0.0;
    for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d& corner_px = seen.detection.corners_px[k];
        const Eigen::Vector2d arm = turn * (corners[k] - nominal.centre_mm);
        angle_by_image.segment<2>(2 * k) = Eigen::RowVector2d(-arm.y(), arm.x()) *
                                           plate_by_image(camera, corner_px, s_mm) /
                                           std::hypot(along, across);
        squares_px2 += (corner_px - project(camera, nominal.centre_mm + arm - aside, s_mm)).squaredNorm();
    }
    const double variance = angle_by_image * seen.covariance_px2 * angle_by_image.transpose();
    return {angle_rad, std::sqrt(variance), std::sqrt(squares_px2 / 8)};
}

}  // namespace

PositionFit fit_position(const CameraGeometry& camera, const PlateTag& nominal, const RefinedTag& seen) {
    const Eigen::Vector2d centre_px =
        seen.explained > 0.0 ? seen.centre_px : centre_by_corners(camera, seen.detection);
    const Eigen::Vector2d from_zero_mm = back_project(camera, centre_px, 0.0);
    const Eigen::Vector2d per_mm = back_project(camera, centre_px, 1.0) - from_zero_mm;
    const double s_mm = (nominal.centre_mm.x() - from_zero_mm.x()) / per_mm.x();
    const double y_mm = nominal.centre_mm.y() - from_zero_mm.y() - s_mm * per_mm.y();

    Eigen::Matrix2d by_plate;  // d (s, y) / d (the plate point seen)
    by_plate << -1.0 / per_mm.x(), 0.0, per_mm.y() / per_mm.x(), -1.0;
    const Eigen::Matrix2d by_image = by_plate * plate_by_image(camera, centre_px, s_mm);
    const Eigen::Vector2d std_mm =
        (by_image * seen.centre_covariance_px2 * by_image.transpose()).diagonal().cwiseSqrt();

    const TagTurn turn = turn_of(camera, nominal, seen, {s_mm, y_mm});
    const TagDetection& tag = seen.detection;
    return {{tag.time_ns, tag.tag_id, s_mm, std_mm.x(), y_mm},
            std_mm.y(),
            turn.angle_rad,
            turn.std_rad,
            turn.residual_rms_px,
            seen};
}

RefinementOptions refinement_of(const CameraGeometry& camera, const PlateTag& tag, const TagDetection& found,
                                const LocateOptions& options) {
    RefinementOptions refinement;
    refinement.camera = camera;
    refinement.noise = options.noise;
    if (options.moved_mm != 0.0) {
        const double s_mm = fit_position(camera, tag, unrefined(found)).position.s_mm;
        refinement.motion_px = project(camera, tag.centre_mm, s_mm + 0.5 * options.moved_mm) -
                               project(camera, tag.centre_mm, s_mm - 0.5 * options.moved_mm);
    }
    return refinement;
}

Result<PositionFit> locate_camera(const CameraGeometry& camera, const Plate& nominal, const Frame& frame,
                                  const std::vector<TagDetection>& found, int expected_tag_id,
                                  const LocateOptions& options) {
    const std::optional<PlateTag> expected = find_tag(nominal, expected_tag_id);
    if (!expected)
        return failure(Reason::wrong_tag, fmt::format("tag {} is not on the plate", expected_tag_id));
    const auto is_expected = [&](const TagDetection& tag) { return tag.tag_id == expected_tag_id; };
    const auto copies = std::count_if(found.begin(), found.end(), is_expected);
    if (copies == 0)
        return tl::make_unexpected(explain_absence(camera, nominal, frame.image, found, *expected, options));
    if (copies > 1)
        return failure(Reason::several_tags, fmt::format("tag {} is seen {} times", expected_tag_id, copies));

    const TagDetection& tag = *std::find_if(found.begin(), found.end(), is_expected);
    if (const double share = saturated_share(frame.image, tag.corners_px); share > options.most_saturated)
        return failure(Reason::glare,
                       fmt::format("{:.1f} % of tag {} is saturated", 100 * share, expected_tag_id));
    const Result<RefinedTag> refined =
        refine_tag(frame.image, tag, refinement_of(camera, *expected, tag, options));
    if (!refined) return tl::make_unexpected(refined.error());
    if (refined->explained < options.least_explained)
        return failure(Reason::occluded, fmt::format("{:.0f} % of the edges of tag {} cannot be seen",
                                                     100 * (1 - refined->explained), expected_tag_id));
    return fit_position(camera, *expected, *refined);
}

}  // namespace fidservo::vision
