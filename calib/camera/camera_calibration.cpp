#include "calib/camera/camera_calibration.h"

#include "calib/camera/bundle.h"
#include "calib/dense.h"
#include "core/failure.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace fidservo::calib {
namespace {

CameraGeometry plain_lens(const CameraCalibrationOptions& options, double focal_px) {
    return {.width_px = options.width_px,
            .height_px = options.height_px,
            .focal_px = focal_px,
            .principal_point_px = {0.5 * (options.width_px - 1), 0.5 * (options.height_px - 1)},
            .distance_mm = 1.0};
}

/// The focal length by which the columns of all homographies become orthogonal and equally long, least
/// squares in 1 / f^2 (Zhang's constraints with the principal point in the middle); a usual one where they do
/// not say.
double start_focal_px(const CameraGeometry& unit_lens, const std::vector<TargetView>& views) {
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

/// A lens and a pose of every view to begin with.
Result<BundleState> start_camera(const std::vector<TargetView>& views,
                                 const CameraCalibrationOptions& options, const Bundle& bundle) {
    const CameraGeometry lens =
        options.start ? *options.start : plain_lens(options, start_focal_px(plain_lens(options, 1.0), views));
    BundleState state{lens_of(lens), {}};
    for (std::size_t view = 0; view < views.size(); ++view) {
        const auto homography = target_homography(lens, views[view]);
        if (!homography)
            return failure(Reason::not_identifiable,
                           views[view].name + ": its tags do not determine where the camera was");
        const PlanePose pose = pose_of_homography(lens, *homography);
        PoseBlock block = block_of(pose), other = block_of(mirrored(pose, views[view]));
        const double chi2 = bundle.adjust_pose(state.lens, view, block);
        if (bundle.adjust_pose(state.lens, view, other) < chi2) block = other;
        state.poses.push_back(block);
    }
    return state;
}

LensMask with(LensMask mask, std::initializer_list<LensParameter> more) {
    for (const LensParameter parameter : more) mask[parameter] = true;
    return mask;
}

/// What the terms must lower chi^2 by, in misfits: the 1 % point of its distribution if they are not there.
struct Candidate {
    std::initializer_list<LensParameter> terms;
    double least_gain;
};

/// Step by step from few parameters to all that are asked for.
void approach(const Bundle& bundle, const CameraCalibrationOptions& options, BundleState& state) {
    const LensMask wanted = options.fitted.value_or(usual_lens());
    LensMask mask{};
    if (options.start) mask = wanted;
    for (const LensParameter next : {focal, k1, centre_u}) {
        mask[next] = wanted[next];
        mask[centre_v] = mask[centre_u] && wanted[centre_v];
        bundle.approach(state, mask);
    }
}

/// Terms that were fitted before are none again, so that the views are asked anew.
void clear_unfitted(Lens& lens, const LensMask& fitted) {
    for (std::size_t k = focal_ratio; k < lens_parameters; ++k)
        if (!fitted[k] && k != centre_u && k != centre_v) lens[k] = k == focal_ratio ? 1.0 : 0.0;
}

/// What is asked for, or the usual lens and what else the views ask for.
std::optional<double> adjust(const Bundle& bundle, const CameraCalibrationOptions& options,
                             BundleState& state, LensMask& mask) {
    mask = options.fitted.value_or(usual_lens());
    if (!options.fitted) mask[focal_ratio] = options.fit_focal_ratio;
    clear_unfitted(state.lens, mask);
    if (options.fitted) return bundle.adjust(state, mask);
    auto chi2 = bundle.adjust(state, mask);
    const std::initializer_list<LensParameter> tangential{p1, p2}, second{k2}, third{k3};
    for (const Candidate& candidate :
         {Candidate{second, 6.63}, Candidate{tangential, 9.21}, Candidate{third, 6.63}}) {
        if (!chi2) break;
        BundleState tried = state;
        const LensMask wider = with(mask, candidate.terms);
        const auto lower = bundle.adjust(tried, wider);
        const double misfit = *chi2 / std::max(1, bundle.measured_directions());
        if (!lower || *chi2 - *lower < candidate.least_gain * std::max(1.0, misfit)) continue;
        state = tried;
        mask = wider;
        chi2 = lower;
    }
    return chi2;
}

ViewFit describe(const Bundle& bundle, const BundleState& state, const TargetView& view, std::size_t index) {
    ViewFit fit{
        .name = view.name, .pose = pose_of(state.poses[index]), .covariance = {}, .rms_px = 0.0, .tags = {}};
    double squares = 0.0, corners = 0.0;
    for (std::size_t tag = 0; tag < view.tags.size(); ++tag) {
        const Eigen::Matrix<double, 8, 1> error = bundle.error_px(state, index, tag);
        SightResidual residual{
            view.tags[tag].printed.id, view.tags[tag].seen.detection.corners_px, {}, bundle.uses(index, tag)};
        for (int k = 0; k < 4; ++k) residual.error_px[static_cast<std::size_t>(k)] = error.segment<2>(2 * k);
        if (residual.used) {
            squares += error.squaredNorm();
            corners += 4.0;
        }
        fit.tags.push_back(residual);
    }
    fit.rms_px = std::sqrt(squares / corners);
    return fit;
}

double rms_px_of(const std::vector<ViewFit>& views) {
    double squares = 0.0, tags = 0.0;
    for (const ViewFit& view : views) {
        const auto used = static_cast<double>(std::ranges::count_if(view.tags, &SightResidual::used));
        squares += used * view.rms_px * view.rms_px;
        tags += used;
    }
    return std::sqrt(squares / tags);
}

}  // namespace

LensMask usual_lens() {
    return with({}, {focal, centre_u, centre_v, k1});
}

double CameraCalibration::std_of(LensParameter parameter) const {
    return std::sqrt(covariance(parameter, parameter));
}

Result<CameraCalibration> calibrate_camera(const std::vector<TargetView>& views,
                                           const CameraCalibrationOptions& options) {
    constexpr int most_rounds = 4;
    if (views.empty()) return failure(Reason::not_identifiable, "there is no view of the target");
    Bundle bundle(views, options.extra_std_px);
    Result<BundleState> started = start_camera(views, options, bundle);
    if (!started) return tl::make_unexpected(started.error());
    BundleState state = *started;
    approach(bundle, options, state);
    bundle.sort_out(state);
    LensMask mask{};
    std::optional<double> chi2;
    for (int round = 0; round < most_rounds; ++round) {
        chi2 = adjust(bundle, options, state, mask);
        if (!chi2) return failure(Reason::no_convergence, "no lens was found that explains the views");
        if (round + 1 == most_rounds || !bundle.sort_out(state)) break;
    }
    const auto covariance = bundle.covariance(state, mask);
    const auto parameters = static_cast<int>(std::ranges::count(mask, true) + 6 * std::ssize(views));
    const int freedom = bundle.measured_directions() - parameters;
    if (!covariance || freedom <= 0 || !(state.lens[focal] > 0.0))
        return failure(Reason::not_identifiable,
                       fmt::format("{} view{} of the target cannot tell the lens", views.size(),
                                   views.size() == 1 ? "" : "s that are too few or too alike"));
    CameraCalibration result{.camera = plain_lens(options, 1.0),
                             .fitted = mask,
                             .covariance = covariance->lens,
                             .views = {},
                             .rms_px = 0.0,
                             .misfit = *chi2 / freedom,
                             .unused = 0};
    set_lens(result.camera, state.lens);
    const double widen = std::max(1.0, result.misfit);
    result.covariance *= widen;
    for (std::size_t view = 0; view < views.size(); ++view) {
        result.views.push_back(describe(bundle, state, views[view], view));
        result.views.back().covariance = widen * covariance->poses[view];
        result.unused += static_cast<std::size_t>(
            std::ranges::count(result.views.back().tags, false, &SightResidual::used));
    }
    result.camera = camera_at(result.camera, result.views.front().pose);
    result.rms_px = rms_px_of(result.views);
    return result;
}

}  // namespace fidservo::calib
