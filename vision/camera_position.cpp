#include "vision/camera_position.h"

#include "vision/quad.h"
#include "vision/tag_choice.h"
#include "vision/tag_pattern.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core.hpp>

namespace fidservo::vision {
namespace {

constexpr unsigned char saturated_level = 255;

/// Share of saturated pixels among those inside the outline.
double saturated_share(const cv::Mat& image, const std::array<Eigen::Vector2d, 4>& corners_px) {
    Eigen::Vector2d low = corners_px[0];
    Eigen::Vector2d high = corners_px[0];
    for (const Eigen::Vector2d& corner : corners_px) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    const auto inside = [&](const Eigen::Vector2d& at) {
        int left_of = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const Eigen::Vector2d side = corners_px[(k + 1) % 4] - corners_px[k];
            const Eigen::Vector2d to = at - corners_px[k];
            left_of += side.x() * to.y() - side.y() * to.x() > 0 ? 1 : 0;
        }
        return left_of == 0 || left_of == 4;
    };
    const int first_row = std::max(0, static_cast<int>(std::ceil(low.y())));
    const int last_row = std::min(image.rows - 1, static_cast<int>(std::floor(high.y())));
    const int first_column = std::max(0, static_cast<int>(std::ceil(low.x())));
    const int last_column = std::min(image.cols - 1, static_cast<int>(std::floor(high.x())));
    long saturated = 0;
    long pixels = 0;
    for (int v = first_row; v <= last_row; ++v)
        for (int u = first_column; u <= last_column; ++u) {
            if (!inside({u, v})) continue;
            ++pixels;
            saturated += image.at<unsigned char>(v, u) == saturated_level ? 1 : 0;
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
        const double side_px = expected.side_mm / mm_per_px(camera);
        const bool another_is_there = std::any_of(found.begin(), found.end(), [&](const TagDetection& tag) {
            return (centre_of(tag.corners_px) - centre_of(place_px)).norm() < 0.5 * side_px;
        });
        if (const double share = saturated_share(image, place_px); share > options.most_saturated)
            return {Reason::glare, fmt::format("{:.1f} % of tag {} is saturated", 100 * share, expected.id)};
        if (!another_is_there && explained_contrast(image, place_px, tag_pattern(expected.id)) > partly_seen)
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

}  // namespace

PositionFit fit_position(const CameraGeometry& camera, const PlateTag& nominal, const RefinedTag& seen) {
    constexpr int steps = 5;  // converges quadratically from any angle that the start below leaves
    const std::array<Eigen::Vector2d, 4> plate_mm = corners_mm(nominal);
    const double scale = mm_per_px(camera);
    const auto& corners_px = seen.detection.corners_px;
    const Eigen::Vector2d diagonal_px = corners_px[1] - corners_px[3];
    const Eigen::Vector2d diagonal_mm = plate_mm[1] - plate_mm[3];

    double phi = std::atan2(diagonal_mm.x() * diagonal_px.y() - diagonal_mm.y() * diagonal_px.x(),
                            diagonal_mm.dot(diagonal_px));
    Eigen::Vector2d axis_mm = nominal.centre_mm;
    Eigen::Matrix<double, 8, 3> jacobian;
    Eigen::Matrix<double, 8, 1> residual;
    Eigen::Matrix<double, 3, 8> gain;
    for (int step = 0; step < steps; ++step) {
        Eigen::Matrix2d turn;
        turn << std::cos(phi), -std::sin(phi), std::sin(phi), std::cos(phi);
        Eigen::Matrix2d turn_rate;
        turn_rate << -std::sin(phi), -std::cos(phi), std::cos(phi), -std::sin(phi);
        for (int k = 0; k < 4; ++k) {
            const Eigen::Vector2d from_axis_px = (plate_mm[k] - axis_mm) / scale;
            residual.segment<2>(2 * k) = corners_px[k] - camera.principal_point_px - turn * from_axis_px;
            jacobian.block<2, 2>(2 * k, 0) = -turn / scale;
            jacobian.block<2, 1>(2 * k, 2) = turn_rate * from_axis_px;
        }
        gain = (jacobian.transpose() * jacobian).ldlt().solve(jacobian.transpose());
        const Eigen::Vector3d change = gain * residual;
        axis_mm += change.head<2>();
        phi += change(2);
    }
    const Eigen::Vector3d std = (gain * seen.covariance_px2 * gain.transpose()).diagonal().cwiseSqrt();
    const TagDetection& tag = seen.detection;
    return {{tag.time_ns, tag.tag_id, axis_mm.x(), std(0), axis_mm.y()},
            std(1),
            phi,
            std(2),
            std::sqrt(residual.squaredNorm() / 8),
            seen};
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
    const Result<RefinedTag> refined = refine_tag(frame.image, tag);
    if (!refined) return tl::make_unexpected(refined.error());
    if (refined->explained < options.least_explained)
        return failure(Reason::occluded, fmt::format("{:.0f} % of an edge of tag {} is hidden",
                                                     100 * (1 - refined->explained), expected_tag_id));
    return fit_position(camera, *expected, *refined);
}

}  // namespace fidservo::vision
