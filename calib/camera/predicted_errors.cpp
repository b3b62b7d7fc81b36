// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/predicted_errors.h"

#include "calib/camera/bundle.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace fidservo::calib {
namespace {

Eigen::Vector2d middle_of(const TargetView& view) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const TagSight& sight : view.tags)
        middle += sight.printed.centre_mm / static_cast<double>(view.tags.size());
    return middle;
}

PlanePose tilted(const PlanePose& pose, const Eigen::Vector2d& middle_mm, const Eigen::Vector3d& turn_rad) {
    const Eigen::Vector3d middle(middle_mm.x(), middle_mm.y(), 0.0);
    PlanePose other;
    other.turn = pose.turn * Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix();
    other.shift_mm = pose.turn * middle + pose.shift_mm - other.turn * middle;
    return other;
}

/// The tags of a view that the lens shows in the image from a pose.
TargetView shown(const CameraGeometry& camera, const TargetView& view, const PlanePose& pose) {
    TargetView result{.name = view.name, .tags = {}};
    const Lens lens = lens_of(camera);
    for (TagSight sight : view.tags) {
        const auto corners_mm = vision::corners_mm(sight.printed);
        bool inside = true;
        for (std::size_t k = 0; k < 4; ++k) {
            const Eigen::Vector3d seen = pose.turn.leftCols<2>() * corners_mm[k] + pose.shift_mm;
            const Eigen::Vector2d at = image_of(camera.distortion.model, lens.data(), seen);
            const bool ahead = camera.distortion.model == LensModel::equidistant || seen.z() > 0.0;
            inside = inside && ahead && at.minCoeff() >= 0.0 && at.x() <= camera.width_px - 1 &&
                     at.y() <= camera.height_px - 1;
            sight.seen.detection.corners_px[k] = at;
        }
        if (inside) result.tags.push_back(sight);
    }
    return result;
}

/// Empty if the views do not determine it.
std::optional<double> focal_std_px(const CameraCalibration& calibration, const std::vector<TargetView>& views,
                                   const std::vector<PlanePose>& poses) {
    const Bundle bundle(calibration.camera.distortion.model, views, 0.0);
    BundleState state{lens_of(calibration.camera), {}};
    for (const PlanePose& pose : poses) state.poses.push_back(block_of(pose));
    const auto covariance = bundle.covariance(state, calibration.fitted);
    if (!covariance) return std::nullopt;
    return std::sqrt(covariance->lens(focal, focal));
}

}  // namespace

std::optional<double> focal_std_if_tilted_px(const CameraCalibration& calibration, double more_tilt_rad) {
    std::vector<TargetView> as_seen, as_tilted;
    std::vector<PlanePose> poses, tilted_poses;
    std::size_t tags = 0, tags_tilted = 0;
    for (const TargetView& view : calibration.seen) {
        const auto fit = std::ranges::find(calibration.views, view.name, &ViewFit::name);
        if (fit == calibration.views.end()) continue;
        const double towards_rad = std::numbers::pi / 2.0 * static_cast<double>(as_seen.size() % 4);
        const Eigen::Vector3d turn_rad =
            more_tilt_rad * Eigen::Vector3d(std::cos(towards_rad), std::sin(towards_rad), 0.0);
        as_seen.push_back(view);
        poses.push_back(fit->pose);
        tilted_poses.push_back(tilted(fit->pose, middle_of(view), turn_rad));
        as_tilted.push_back(shown(calibration.camera, view, tilted_poses.back()));
        if (as_tilted.back().tags.empty()) return std::nullopt;
        tags += view.tags.size();
        tags_tilted += as_tilted.back().tags.size();
    }
    if (2 * tags_tilted < tags) return std::nullopt;
    const auto now_px = focal_std_px(calibration, as_seen, poses);
    const auto then_px = focal_std_px(calibration, as_tilted, tilted_poses);
    if (!then_px) return std::nullopt;
    // What stands in the covariance beside the Jacobian, the misfit and terms left out, is there then too.
    const double beside =
        now_px ? calibration.std_of(focal) / *now_px : std::sqrt(std::max(1.0, calibration.misfit));
    return beside * *then_px;
}

}  // namespace fidservo::calib
