// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/stage/camera_mount.h"

#include "calib/camera/lens_projection.h"
#include "calib/camera/plane_pose.h"
#include "core/camera/camera_slopes.h"
#include "core/failure.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace fidservo::calib {
namespace {

enum MountParameter { rotation, tilt_u, tilt_v, distance, mount_parameters };
using Mount = std::array<double, mount_parameters>;
using Place = std::array<double, 2>;  ///< s, y

/// Image points of a tag's corners as eight numbers.
template <class T>
Eigen::Matrix<T, 8, 1> corners_from_mount(LensModel model, const Lens& lens, const Eigen::Vector3d& axis,
                                          const std::array<Eigen::Vector2d, 4>& printed_mm, const T* mount,
                                          const T* place) {
    const std::array<T, 3> tilt{mount[tilt_u], mount[tilt_v], T(0.0)};
    const std::array<T, 3> about_z{T(0.0), T(0.0), mount[rotation]};
    std::array<T, lens_parameters> lens_T;
    std::transform(lens.begin(), lens.end(), lens_T.begin(), [](double value) { return T(value); });
    Eigen::Matrix<T, 8, 1> corners;
    for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d& p = printed_mm[static_cast<std::size_t>(k)];
        const std::array<T, 3> from_camera{p.x() - place[0] * axis.x(),
                                           p.y() - place[0] * axis.y() - place[1],
                                           mount[distance] - place[0] * axis.z()};
        std::array<T, 3> turned;
        Eigen::Matrix<T, 3, 1> seen;
        ceres::AngleAxisRotatePoint(about_z.data(), from_camera.data(), turned.data());
        ceres::AngleAxisRotatePoint(tilt.data(), turned.data(), seen.data());
        corners.template segment<2>(2 * k) = image_of(model, lens_T.data(), seen);
    }
    return corners;
}

Eigen::Matrix<double, 8, 1> seen_corners_px(const TagSight& sight) {
    Eigen::Matrix<double, 8, 1> corners;
    for (int k = 0; k < 4; ++k)
        corners.segment<2>(2 * k) = sight.seen.detection.corners_px[static_cast<std::size_t>(k)];
    return corners;
}

struct MountResidual {
    LensModel model;
    Lens lens;
    Eigen::Vector3d axis;
    std::array<Eigen::Vector2d, 4> printed_mm;
    Eigen::Matrix<double, 8, 1> seen_px;
    Eigen::Matrix<double, 8, 8> whiten;

    template <class T>
    bool operator()(const T* mount, const T* place, T* residual) const {
        Eigen::Map<Eigen::Matrix<T, 8, 1>> out(residual);
        const Eigen::Matrix<T, 8, 1> error =
            corners_from_mount(model, lens, axis, printed_mm, mount, place) - seen_px;
        out = whiten.cast<T>() * error;
        return true;
    }
};

/// The mount by the view that shows most tags, and every view's place by its own homography.
Status start_mount(const CameraGeometry& lens, const std::vector<TargetView>& views, Mount& mount,
                   std::vector<Place>& places) {
    const Eigen::Vector3d axis = stage_axis(lens);
    std::size_t most_tags = 1;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto pose = plane_pose(lens, views[i]);
        if (!pose)
            return failure(Reason::not_identifiable, views[i].name + ": its tags do not determine a pose");
        const Eigen::Vector3d centre = pose->centre_mm();
        const double s_mm = centre.x() / axis.x();
        places[i] = {s_mm, centre.y() - s_mm * axis.y()};
        if (views[i].tags.size() <= most_tags) continue;
        most_tags = views[i].tags.size();
        const CameraGeometry camera = camera_at(lens, *pose);
        mount = {camera.rotation_rad, camera.tilt_rad.x(), camera.tilt_rad.y(),
                 camera.distance_mm + s_mm * axis.z()};
    }
    if (most_tags < 2)
        return failure(Reason::not_identifiable, "no view shows two tags: tilt and distance are unknown");
    return {};
}

struct MisfitSums {
    double squared_px = 0.0, corners = 0.0;
    double rms_px() const { return std::sqrt(squared_px / corners); }
};

}  // namespace

Result<CameraMount> fit_camera_mount(const CameraGeometry& lens, const std::vector<TargetView>& views) {
    Mount mount{};
    std::vector<Place> places(views.size());
    if (const Status started = start_mount(lens, views, mount, places); !started)
        return tl::make_unexpected(started.error());

    const LensModel model = lens.distortion.model;
    const Lens numbers = lens_of(lens);
    const Eigen::Vector3d axis = stage_axis(lens);
    ceres::Problem problem;
    int measured = 0;
    for (std::size_t i = 0; i < views.size(); ++i)
        for (const TagSight& sight : views[i].tags) {
            const CornerWeights weights = corner_weights(sight.seen.covariance_px2, 0.0);
            measured += weights.rank;
            problem.AddResidualBlock(
                new ceres::AutoDiffCostFunction<MountResidual, 8, mount_parameters, 2>(
                    new MountResidual{model, numbers, axis, vision::corners_mm(sight.printed),
                                      seen_corners_px(sight), weights.whiten}),
                nullptr, mount.data(), places[i].data());
        }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-14;
    options.parameter_tolerance = 1e-13;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (summary.termination_type != ceres::CONVERGENCE || !(mount[distance] > 0.0))
        return failure(Reason::no_convergence, "the camera's mount cannot be fitted: " + summary.message);

    ceres::Covariance::Options how;
    how.algorithm_type = ceres::SPARSE_QR;
    ceres::Covariance covariance(how);
    std::vector<std::pair<const double*, const double*>> blocks{{mount.data(), mount.data()}};
    for (const Place& place : places) blocks.emplace_back(place.data(), place.data());
    if (!covariance.Compute(blocks, &problem))
        return failure(Reason::not_identifiable, "the views do not determine the camera's mount");

    const int freedom = measured - mount_parameters - 2 * static_cast<int>(views.size());
    CameraMount result{.camera = lens, .covariance = {}, .views = {}, .rms_px = 0.0, .misfit = 1.0};
    result.misfit = freedom > 0 ? 2.0 * summary.final_cost / freedom : 1.0;
    const double widen = std::max(1.0, result.misfit);
    result.camera.rotation_rad = mount[rotation];
    result.camera.tilt_rad = {mount[tilt_u], mount[tilt_v]};
    result.camera.distance_mm = mount[distance];
    covariance.GetCovarianceBlock(mount.data(), mount.data(), result.covariance.data());
    result.covariance *= widen;
    MisfitSums all;
    for (std::size_t i = 0; i < views.size(); ++i) {
        MisfitSums sums;
        for (const TagSight& sight : views[i].tags) {
            sums.squared_px += (corners_from_mount(model, numbers, axis, vision::corners_mm(sight.printed),
                                                   mount.data(), places[i].data()) -
                                seen_corners_px(sight))
                                   .squaredNorm();
            sums.corners += 4.0;
        }
        all.squared_px += sums.squared_px;
        all.corners += sums.corners;
        Eigen::Matrix2d place;
        covariance.GetCovarianceBlock(places[i].data(), places[i].data(), place.data());
        result.views.push_back({places[i][0], std::sqrt(widen * place(0, 0)), places[i][1],
                                std::sqrt(widen * place(1, 1)), sums.rms_px()});
    }
    result.rms_px = all.rms_px();
    return result;
}

}  // namespace fidservo::calib
