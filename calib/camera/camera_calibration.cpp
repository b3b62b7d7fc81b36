// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/camera_calibration.h"

#include "calib/camera/bundle.h"
#include "calib/camera/calibration_start.h"
#include "core/failure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

namespace fidservo::calib {
namespace {

LensMask with(LensMask mask, std::span<const LensParameter> more) {
    for (const LensParameter parameter : more) mask[parameter] = true;
    return mask;
}

/// What the terms must lower chi^2 by, in misfits: the 1 % point of its distribution if they are not there.
struct Candidate {
    std::vector<LensParameter> terms;
    double least_gain;
};

/// Of an equidistant lens the last three may be found together where none is alone.
std::vector<Candidate> candidates_of(LensModel model) {
    constexpr double one = 6.63, two = 9.21, three = 11.34;
    if (model == LensModel::equidistant)
        return {{{k2}, one}, {{k3}, one}, {{k4}, one}, {{k2, k3, k4}, three}};
    return {{{k2}, one}, {{p1, p2}, two}, {{k3}, one}};
}

/// Terms that a lens may have although they were left out: those that the views do not ask for, and the
/// decentring that an equidistant lens has no numbers for.
std::vector<Candidate> left_out_of(LensModel model) {
    std::vector<Candidate> left_out = candidates_of(model);
    if (model == LensModel::equidistant) left_out.insert(left_out.begin(), {{p1, p2}, 0.0});
    return left_out;
}

/// Step by step from few parameters to all that are asked for. Returns twice the robust loss.
double approach(const Bundle& bundle, const CameraCalibrationOptions& options,
                const std::vector<TargetView>& views, BundleState& state) {
    const LensMask wanted = options.fitted.value_or(usual_lens());
    LensMask mask{};
    if (options.start) mask = wanted;
    mask[tag_scale] = options.fit_tag_scale;
    double loss = 0.0;
    for (const LensParameter next : {focal, k1, centre_u}) {
        mask[next] = wanted[next];
        mask[centre_v] = mask[centre_u] && wanted[centre_v];
        loss = bundle.approach(state, mask);
    }
    if (turn_poses(state, views, bundle)) loss = bundle.approach(state, mask);
    return loss;
}

/// The best state that the starts lead to.
Result<BundleState> approach_from_all(const Bundle& bundle, const CameraCalibrationOptions& options,
                                      const std::vector<TargetView>& views) {
    std::vector<CameraGeometry> starts;
    if (options.start)
        starts.push_back(*options.start);
    else
        starts = start_lenses(options, views);
    Result<BundleState> best = failure(Reason::no_convergence, "no lens was found that explains the views");
    double least = std::numeric_limits<double>::infinity();
    for (const CameraGeometry& lens : starts) {
        Result<BundleState> state = start_camera(lens, views, bundle);
        if (!state) {
            if (!best) best = state;
            continue;
        }
        const double loss = approach(bundle, options, views, *state);
        if (!(loss < least) || !(state->lens[focal] > 0.0)) continue;
        least = loss;
        best = state;
    }
    return best;
}

/// Terms that were fitted before are none again, so that the views are asked anew.
void clear_unfitted(Lens& lens, const LensMask& fitted) {
    for (std::size_t k = k1; k <= k4; ++k)
        if (!fitted[k]) lens[k] = 0.0;
    for (const LensParameter share : {focal_ratio, tag_scale})
        if (!fitted[share]) lens[share] = 1.0;
}

/// What is asked for, or the usual lens and what else the views ask for.
std::optional<double> adjust(const Bundle& bundle, const CameraCalibrationOptions& options,
                             BundleState& state, LensMask& mask) {
    mask = options.fitted.value_or(usual_lens());
    if (!options.fitted) {
        mask[focal_ratio] = options.fit_focal_ratio;
        mask[tag_scale] = options.fit_tag_scale;
    }
    clear_unfitted(state.lens, mask);
    if (options.fitted) return bundle.adjust(state, mask);
    auto chi2 = bundle.adjust(state, mask);
    for (const Candidate& candidate : candidates_of(options.model)) {
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

/// That of the fitted numbers where terms were left out (left_out_of()): they need not be zero. With all of
/// the model's terms in the fit the numbers have the covariance C and differ by d from those without; that of
/// the latter about the truth is bounded by C + d d^T. The poses' likewise.
std::optional<BundleCovariance> covariance_of(const Bundle& bundle, const CameraCalibrationOptions& options,
                                              const BundleState& state, const LensMask& fitted) {
    std::vector<Candidate> candidates =
        options.fitted ? std::vector<Candidate>{} : left_out_of(options.model);
    for (; !candidates.empty(); candidates.pop_back()) {
        LensMask wider = fitted;
        for (const Candidate& candidate : candidates) wider = with(wider, candidate.terms);
        BundleState all = state;
        if (!bundle.adjust(all, wider)) continue;
        auto covariance = bundle.covariance(all, wider);
        if (!covariance) continue;
        Eigen::Matrix<double, lens_parameters, 1> step, kept;
        for (int k = 0; k < lens_parameters; ++k) {
            kept(k) = fitted[static_cast<std::size_t>(k)] ? 1.0 : 0.0;
            step(k) = all.lens[static_cast<std::size_t>(k)] - state.lens[static_cast<std::size_t>(k)];
        }
        covariance->lens += step * step.transpose();
        covariance->lens = (kept.asDiagonal() * covariance->lens * kept.asDiagonal()).eval();
        for (std::size_t view = 0; view < state.poses.size(); ++view) {
            const Eigen::Matrix<double, 6, 1> moved =
                Eigen::Map<const Eigen::Matrix<double, 6, 1>>(all.poses[view].data()) -
                Eigen::Map<const Eigen::Matrix<double, 6, 1>>(state.poses[view].data());
            covariance->poses[view] += moved * moved.transpose();
        }
        return covariance;
    }
    return bundle.covariance(state, fitted);
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
    constexpr std::array usual{focal, centre_u, centre_v, k1};
    return with({}, usual);
}

double CameraCalibration::std_of(LensParameter parameter) const {
    return std::sqrt(covariance(parameter, parameter));
}

Result<CameraCalibration> calibrate_camera(const std::vector<TargetView>& views,
                                           const CameraCalibrationOptions& options) {
    constexpr int most_rounds = 4;
    if (views.empty()) return failure(Reason::not_identifiable, "there is no view of the target");
    Bundle bundle(options.model, views, options.extra_std_px);
    Result<BundleState> started = approach_from_all(bundle, options, views);
    if (!started) return tl::make_unexpected(started.error());
    BundleState state = *started;
    bundle.sort_out(state);
    LensMask mask{};
    std::optional<double> chi2;
    for (int round = 0; round < most_rounds; ++round) {
        chi2 = adjust(bundle, options, state, mask);
        if (!chi2) return failure(Reason::no_convergence, "no lens was found that explains the views");
        if (round + 1 == most_rounds || !bundle.sort_out(state)) break;
    }
    const auto parameters = static_cast<int>(std::ranges::count(mask, true) + 6 * std::ssize(views));
    const int freedom = bundle.measured_directions() - parameters;
    if (freedom <= 0)
        return failure(
            Reason::not_identifiable,
            fmt::format("{} view{} of the target measure{} {} numbers of tags, and the lens and the "
                        "views' places are {}: more views or more tags are needed",
                        views.size(), views.size() == 1 ? "" : "s", views.size() == 1 ? "s" : "",
                        bundle.measured_directions(), parameters));
    const auto covariance = covariance_of(bundle, options, state, mask);
    if (!covariance || !(state.lens[focal] > 0.0))
        return failure(
            Reason::not_identifiable,
            fmt::format("{} view{} of the target, as it is described, do{} not determine the lens",
                        views.size(), views.size() == 1 ? "" : "s", views.size() == 1 ? "es" : ""));
    CameraCalibration result{.camera = plain_lens(options, 1.0),
                             .fitted = mask,
                             .covariance = covariance->lens,
                             .views = {},
                             .rms_px = 0.0,
                             .chi2 = *chi2,
                             .freedom = freedom,
                             .misfit = *chi2 / freedom,
                             .unused = 0,
                             .seen = views};
    set_lens(result.camera, state.lens);
    result.tag_scale = state.lens[tag_scale];
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
