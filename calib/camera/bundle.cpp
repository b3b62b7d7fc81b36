// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/bundle.h"

#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace fidservo::calib {
namespace {

template <class T>
Eigen::Matrix<T, 8, 1> corners_from_pose(LensModel model, const std::array<Eigen::Vector2d, 4>& printed_mm,
                                         const T* lens, const T* pose) {
    Eigen::Matrix<T, 8, 1> corners;
    const Eigen::Vector2d middle = 0.25 * (printed_mm[0] + printed_mm[1] + printed_mm[2] + printed_mm[3]);
    for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d from_middle = printed_mm[static_cast<std::size_t>(k)] - middle;
        const std::array<T, 3> point{middle.x() + lens[tag_scale] * from_middle.x(),
                                     middle.y() + lens[tag_scale] * from_middle.y(), T(0.0)};
        Eigen::Matrix<T, 3, 1> seen;
        ceres::AngleAxisRotatePoint(pose, point.data(), seen.data());
        for (int axis = 0; axis < 3; ++axis) seen(axis) += pose[3 + axis];
        corners.template segment<2>(2 * k) = image_of(model, lens, seen);
    }
    return corners;
}

ceres::Solver::Options solver_options(ceres::LinearSolverType solver) {
    ceres::Solver::Options options;
    options.linear_solver_type = solver;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-11;
    options.parameter_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    return options;
}

}  // namespace

PoseBlock block_of(const PlanePose& pose) {
    const Eigen::AngleAxisd turn(pose.turn);
    PoseBlock block;
    Eigen::Map<Eigen::Vector3d>(block.data()) = turn.angle() * turn.axis();
    Eigen::Map<Eigen::Vector3d>(block.data() + 3) = pose.shift_mm;
    return block;
}

PlanePose pose_of(const PoseBlock& block) {
    PlanePose pose;
    ceres::AngleAxisToRotationMatrix(block.data(), pose.turn.data());
    pose.shift_mm = {block[3], block[4], block[5]};
    return pose;
}

struct Bundle::Residual {
    LensModel model;
    Sight sight;
    template <class T>
    bool operator()(const T* lens, const T* pose, T* residual) const {
        const Eigen::Matrix<T, 8, 1> error =
            sight.seen_px - corners_from_pose(model, sight.printed_mm, lens, pose);
        // Written out: a weight has no derivatives, as a number that is made a T would.
        for (int row = 0; row < 8; ++row) {
            residual[row] = sight.weights.whiten(row, 0) * error(0);
            for (int column = 1; column < 8; ++column)
                residual[row] += sight.weights.whiten(row, column) * error(column);
        }
        return true;
    }
    static ceres::CostFunction* of(LensModel model, const Sight& sight) {
        return new ceres::AutoDiffCostFunction<Residual, 8, lens_parameters, 6>(new Residual{model, sight});
    }
};

struct Bundle::Problem {
    ceres::Problem terms;
};

Bundle::Bundle(LensModel model, const std::vector<TargetView>& views, double extra_std_px) : model_(model) {
    for (const TargetView& view : views) {
        std::vector<Sight>& sights = sights_.emplace_back();
        for (const TagSight& tag : view.tags) {
            Sight sight{
                vision::corners_mm(tag.printed), {}, corner_weights(tag.seen.covariance_px2, extra_std_px)};
            for (int k = 0; k < 4; ++k)
                sight.seen_px.segment<2>(2 * k) = tag.seen.detection.corners_px[static_cast<std::size_t>(k)];
            sights.push_back(sight);
        }
    }
}

void Bundle::build(Problem& problem, BundleState& state, const LensFlags& fitted, bool robust) const {
    constexpr double far_off = 10.0;  // in standard deviations
    ceres::Problem& terms = problem.terms;
    terms.AddParameterBlock(state.lens.data(), lens_parameters);
    for (std::size_t view = 0; view < sights_.size(); ++view)
        for (const Sight& sight : sights_[view])
            if (sight.used)
                terms.AddResidualBlock(Residual::of(model_, sight),
                                       robust ? new ceres::HuberLoss(far_off) : nullptr, state.lens.data(),
                                       state.poses[view].data());
    std::vector<int> held;
    for (int k = 0; k < lens_parameters; ++k)
        if (!fitted[static_cast<std::size_t>(k)]) held.push_back(k);
    if (held.size() == lens_parameters)
        terms.SetParameterBlockConstant(state.lens.data());
    else if (!held.empty())
        terms.SetManifold(state.lens.data(), new ceres::SubsetManifold(lens_parameters, held));
}

std::optional<double> Bundle::adjust(BundleState& state, const LensFlags& fitted) const {
    Problem problem;
    build(problem, state, fitted, false);
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(ceres::DENSE_SCHUR), &problem.terms, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    return 2.0 * summary.final_cost;
}

double Bundle::approach(BundleState& state, const LensFlags& fitted) const {
    Problem problem;
    build(problem, state, fitted, true);
    ceres::Solver::Options options = solver_options(ceres::DENSE_SCHUR);
    options.function_tolerance = 1e-4;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem.terms, &summary);
    return 2.0 * summary.final_cost;
}

double Bundle::adjust_pose(const Lens& lens, std::size_t view, PoseBlock& pose) const {
    Lens held = lens;
    ceres::Problem terms;
    for (const Sight& sight : sights_[view])
        terms.AddResidualBlock(Residual::of(model_, sight), nullptr, held.data(), pose.data());
    terms.SetParameterBlockConstant(held.data());
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(ceres::DENSE_QR), &terms, &summary);
    return summary.final_cost * 2.0;
}

std::optional<BundleCovariance> Bundle::covariance(BundleState state, const LensFlags& fitted) const {
    Problem problem;
    build(problem, state, fitted, false);
    ceres::Covariance::Options how;
    how.algorithm_type = ceres::SPARSE_QR;
    ceres::Covariance covariance(how);
    std::vector<std::pair<const double*, const double*>> blocks{{state.lens.data(), state.lens.data()}};
    for (std::size_t view = 0; view < sights_.size(); ++view)
        if (problem.terms.HasParameterBlock(state.poses[view].data()))
            blocks.emplace_back(state.poses[view].data(), state.poses[view].data());
    if (!covariance.Compute(blocks, &problem.terms)) return std::nullopt;

    BundleCovariance result;
    covariance.GetCovarianceBlock(state.lens.data(), state.lens.data(), result.lens.data());
    result.poses.resize(sights_.size(), Eigen::Matrix<double, 6, 6>::Zero());
    for (std::size_t k = 1; k < blocks.size(); ++k) {
        const auto pose =
            std::ranges::find(state.poses, blocks[k].first, [](const PoseBlock& p) { return p.data(); });
        covariance.GetCovarianceBlock(
            pose->data(), pose->data(),
            result.poses[static_cast<std::size_t>(pose - state.poses.begin())].data());
    }
    return result;
}

Eigen::Matrix<double, 8, 1> Bundle::error_px(const BundleState& state, std::size_t view,
                                             std::size_t tag) const {
    const Sight& sight = sights_[view][tag];
    return sight.seen_px -
           corners_from_pose(model_, sight.printed_mm, state.lens.data(), state.poses[view].data());
}

double Bundle::mean_square(const BundleState& state, std::size_t view, std::size_t tag) const {
    const CornerWeights& weights = sights_[view][tag].weights;
    return (weights.whiten * error_px(state, view, tag)).squaredNorm() / std::max(weights.rank, 1);
}

bool Bundle::sort_out(const BundleState& state) {
    constexpr double most_ratio = 16.0;
    std::vector<double> all;
    for (std::size_t view = 0; view < sights_.size(); ++view)
        for (std::size_t tag = 0; tag < sights_[view].size(); ++tag)
            all.push_back(mean_square(state, view, tag));
    if (all.empty()) return false;
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    const double limit = most_ratio * *middle;
    bool changed = false;
    for (std::size_t view = 0; view < sights_.size(); ++view) {
        std::vector<Sight>& tags = sights_[view];
        std::vector<bool> fits(tags.size());
        for (std::size_t tag = 0; tag < tags.size(); ++tag)
            fits[tag] = mean_square(state, view, tag) <= limit;
        // A view's pose stays determined by one tag; it weighs nothing against the others.
        if (!fits.empty() && std::ranges::none_of(fits, std::identity{})) fits.front() = true;
        for (std::size_t tag = 0; tag < tags.size(); ++tag) {
            changed = changed || tags[tag].used != fits[tag];
            tags[tag].used = fits[tag];
        }
    }
    return changed;
}

int Bundle::measured_directions() const {
    int sum = 0;
    for (const auto& view : sights_)
        for (const Sight& sight : view)
            if (sight.used) sum += sight.weights.rank;
    return sum;
}

}  // namespace fidservo::calib
