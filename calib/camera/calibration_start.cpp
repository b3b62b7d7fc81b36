// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/calibration_start.h"

#include "calib/camera/plane_pose.h"
#include "calib/dense.h"
#include "core/failure.h"
#include "core/median.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

namespace fidservo::calib {
namespace {

/// The focal length by which the columns of all homographies become orthogonal and equally long, least
/// squares in 1 / f^2 (Zhang's constraints with the principal point in the middle); a usual one where they do
/// not say.
double focal_of_homographies_px(const CameraGeometry& unit_lens, const std::vector<TargetView>& views) {
    double products = 0.0, squares = 0.0;
    for (const TargetView& view : views) {
        const auto found = target_homography(unit_lens, view);
        if (!found) continue;
        const Eigen::Matrix3d& h = *found;
        const auto add = [&](double with_focal, double without) {
            products += with_focal * without;
            squares += with_focal * with_focal;
        };
        add(h.col(0).head<2>().dot(h.col(1).head<2>()), h(2, 0) * h(2, 1));
        add(h.col(0).head<2>().squaredNorm() - h.col(1).head<2>().squaredNorm(),
            h(2, 0) * h(2, 0) - h(2, 1) * h(2, 1));
    }
    const double longest_px = std::max(unit_lens.width_px, unit_lens.height_px);
    const double focal_px = std::sqrt(-squares / products);
    const bool plausible = focal_px > 0.2 * longest_px && focal_px < 50.0 * longest_px;
    return plausible ? focal_px : 1.2 * longest_px;
}

double outermost_px(const CameraGeometry& lens, const std::vector<TargetView>& views) {
    double outermost = 0.0;
    for (const TargetView& view : views)
        for (const TagSight& sight : view.tags)
            for (const Eigen::Vector2d& corner : sight.seen.detection.corners_px)
                outermost = std::max(outermost, (corner - lens.principal_point_px).norm());
    return outermost;
}

/// Of the views some are enough for a focal length to a quarter.
std::vector<TargetView> some_of(const std::vector<TargetView>& views) {
    constexpr std::size_t enough = 8;
    const std::size_t every = (views.size() + enough - 1) / enough;
    std::vector<TargetView> some;
    for (std::size_t k = 0; k < views.size(); k += every) some.push_back(views[k]);
    return some;
}

CameraGeometry lens_of_least_error(const CameraCalibrationOptions& options,
                                   const std::vector<TargetView>& views) {
    constexpr double step = 1.25, longest = 50.0;  // the latter in widths of the image
    const std::vector<TargetView> some = some_of(views);
    const double shortest_px = 1.05 * outermost_px(plain_lens(options, 1.0), views) / std::numbers::pi;
    const double longest_px = longest * std::max(options.width_px, options.height_px);
    CameraGeometry best = plain_lens(options, options.width_px);
    double least_px = std::numeric_limits<double>::infinity();
    for (double focal_px = std::max(1.0, shortest_px); focal_px < longest_px; focal_px *= step) {
        const CameraGeometry lens = plain_lens(options, focal_px);
        const double error_px = rough_error_px(lens, some);
        if (!(error_px < least_px)) continue;
        least_px = error_px;
        best = lens;
    }
    return best;
}

/// The other pose that looks nearly the same from afar: the target's normal mirrored at the line of sight.
PlanePose mirrored(const PlanePose& pose, const TargetView& view) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const TagSight& sight : view.tags)
        middle.head<2>() += sight.printed.centre_mm / static_cast<double>(view.tags.size());
    const Eigen::Vector3d seen = pose.turn * middle + pose.shift_mm;
    const Eigen::Vector3d sight_line = seen.normalized();
    const Eigen::Vector3d normal = pose.turn.col(2);
    const Eigen::Vector3d other = 2.0 * sight_line.dot(normal) * sight_line - normal;
    PlanePose result;
    result.turn = turn_between(normal, other).toRotationMatrix() * pose.turn;
    result.shift_mm = seen - result.turn * middle;
    return result;
}

}  // namespace

CameraGeometry plain_lens(const CameraCalibrationOptions& options, double focal_px) {
    CameraGeometry lens{.width_px = options.width_px,
                        .height_px = options.height_px,
                        .focal_px = focal_px,
                        .principal_point_px = {0.5 * (options.width_px - 1), 0.5 * (options.height_px - 1)},
                        .distance_mm = 1.0};
    lens.distortion.model = options.model;
    return lens;
}

std::vector<CameraGeometry> start_lenses(const CameraCalibrationOptions& options,
                                         const std::vector<TargetView>& views) {
    std::vector<CameraGeometry> lenses{lens_of_least_error(options, views)};
    if (options.model == LensModel::equidistant) return lenses;
    lenses.push_back(plain_lens(options, focal_of_homographies_px(plain_lens(options, 1.0), views)));
    CameraCalibrationOptions as_fisheye = options;
    as_fisheye.model = LensModel::equidistant;
    CameraGeometry barrel = plain_lens(options, lens_of_least_error(as_fisheye, views).focal_px);
    barrel.distortion.k1 = -1.0 / 3.0;  // theta = atan(r) as a series
    barrel.distortion.k2 = 1.0 / 5.0;
    lenses.push_back(barrel);
    return lenses;
}

double rough_error_px(const CameraGeometry& lens, const std::vector<TargetView>& views) {
    const Lens numbers = lens_of(lens);
    std::vector<double> errors_px;
    for (const TargetView& view : views) {
        const auto pose = plane_pose(lens, view);
        if (!pose) return std::numeric_limits<double>::infinity();
        for (const TagSight& sight : view.tags) {
            const auto corners_mm = vision::corners_mm(sight.printed);
            for (std::size_t k = 0; k < 4; ++k) {
                const Eigen::Vector3d seen = pose->turn.leftCols<2>() * corners_mm[k] + pose->shift_mm;
                errors_px.push_back((image_of(lens.distortion.model, numbers.data(), seen) -
                                     sight.seen.detection.corners_px[k])
                                        .norm());
            }
        }
    }
    return errors_px.empty() ? std::numeric_limits<double>::infinity() : median_of(errors_px);
}

Result<BundleState> start_camera(const CameraGeometry& lens, const std::vector<TargetView>& views,
                                 const Bundle& bundle) {
    BundleState state{lens_of(lens), {}};
    for (std::size_t view = 0; view < views.size(); ++view) {
        const auto pose = plane_pose(lens, views[view]);
        if (!pose)
            return failure(Reason::not_identifiable,
                           views[view].name + ": its tags do not determine where the camera was");
        PoseBlock block = block_of(*pose), other = block_of(mirrored(*pose, views[view]));
        const double chi2 = bundle.adjust_pose(state.lens, view, block);
        if (bundle.adjust_pose(state.lens, view, other) < chi2) block = other;
        state.poses.push_back(block);
    }
    return state;
}

bool turn_poses(BundleState& state, const std::vector<TargetView>& views, const Bundle& bundle) {
    bool turned = false;
    for (std::size_t view = 0; view < views.size(); ++view) {
        PoseBlock block = state.poses[view], other = block_of(mirrored(pose_of(block), views[view]));
        const double chi2 = bundle.adjust_pose(state.lens, view, block);
        if (!(bundle.adjust_pose(state.lens, view, other) < chi2)) continue;
        state.poses[view] = other;
        turned = true;
    }
    return turned;
}

}  // namespace fidservo::calib
