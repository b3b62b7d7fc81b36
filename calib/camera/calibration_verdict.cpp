// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/calibration_verdict.h"

#include "calib/camera/other_explanations.h"
#include "calib/camera/predicted_errors.h"
#include "calib/significance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace fidservo::calib {
namespace {

constexpr double deg = std::numbers::pi / 180.0;

double angle_rad(const Eigen::Matrix3d& turn) {
    return std::acos(std::clamp(0.5 * (turn.trace() - 1.0), -1.0, 1.0));
}

bool alike(const PlanePose& a, const PlanePose& b) {
    constexpr double least_angle_rad = 1.0 * deg;
    constexpr double least_way = 0.02;
    return angle_rad(a.turn.transpose() * b.turn) < least_angle_rad &&
           (a.centre_mm() - b.centre_mm()).norm() < least_way * std::abs(a.centre_mm().z());
}

}  // namespace

Coverage coverage_of(const CameraCalibration& calibration) {
    Coverage coverage{std::vector<int>(Coverage::columns * Coverage::rows), 0.0};
    const auto cell = [](double at_px, int size_px, int cells) {
        return std::clamp(static_cast<int>((at_px + 0.5) * cells / size_px), 0, cells - 1);
    };
    for (const ViewFit& view : calibration.views)
        for (const SightResidual& tag : view.tags)
            for (const Eigen::Vector2d& corner : tag.seen_px)
                ++coverage.corners[cell(corner.y(), calibration.camera.height_px, Coverage::rows) *
                                       Coverage::columns +
                                   cell(corner.x(), calibration.camera.width_px, Coverage::columns)];
    const auto empty = std::ranges::count(coverage.corners, 0);
    coverage.share = 1.0 - static_cast<double>(empty) / static_cast<double>(coverage.corners.size());
    return coverage;
}

double widest_tilt_rad(const CameraCalibration& calibration) {
    double widest = 0.0;
    for (const ViewFit& a : calibration.views)
        for (const ViewFit& b : calibration.views) {
            // The target's normal in the camera's frame; the camera itself may turn about it.
            const double cosine = a.pose.turn.col(2).dot(b.pose.turn.col(2));
            widest = std::max(widest, std::acos(std::clamp(cosine, -1.0, 1.0)));
        }
    return widest;
}

int different_views(const CameraCalibration& calibration) {
    std::vector<PlanePose> kept;
    for (const ViewFit& view : calibration.views)
        if (std::ranges::none_of(kept, [&](const PlanePose& other) { return alike(view.pose, other); }))
            kept.push_back(view.pose);
    return static_cast<int>(kept.size());
}

namespace {

double percent_of_focal(const CameraCalibration& calibration, double std_px) {
    return 100.0 * std_px / calibration.camera.focal_px;
}

/// What would determine the focal length better, as far as that was worked out.
std::string focal_advice(const CameraCalibration& calibration, const CalibrationLimits& limits) {
    constexpr double more_tilt_rad = 30.0 * deg;
    constexpr double most_times = 10.0;
    const double limit_px = limits.most_focal_std * calibration.camera.focal_px;
    const std::string tilt_now =
        fmt::format("the target's tilt differs by {:.2g} degrees at most between the views",
                    widest_tilt_rad(calibration) / deg);
    const auto tilted_px = focal_std_if_tilted_px(calibration, more_tilt_rad);
    if (tilted_px && *tilted_px <= limit_px)
        return fmt::format(
            "; {}: with {:.0f} degrees more, to all sides, it would be known to {:.2g} %: tilt it more",
            tilt_now, more_tilt_rad / deg, percent_of_focal(calibration, *tilted_px));
    const double times = std::pow(calibration.std_of(focal) / limit_px, 2);
    if (times <= most_times)
        return fmt::format("; {:.0f} times as many views like these would determine it", std::ceil(times));
    if (tilted_px && *tilted_px < 0.5 * calibration.std_of(focal))
        return fmt::format(
            "; {}: {:.0f} degrees more, to all sides, would bring it to {:.2g} %, and more views or "
            "sharper corners the rest",
            tilt_now, more_tilt_rad / deg, percent_of_focal(calibration, *tilted_px));
    return "; neither more tilt nor ten times as many views like these would determine it";
}

/// R.m.s. distance of used corners in the inner and the outer half of them, and whether they differ beyond
/// chance: corners of a tag count once.
struct Growth {
    double inner_px, outer_px;
    bool is_real;
};

Growth growth_of(const CameraCalibration& calibration) {
    struct Tag {
        double radius_px, square_px2;
    };
    std::vector<Tag> tags;
    for (const ViewFit& view : calibration.views)
        for (const SightResidual& tag : view.tags) {
            Tag at{0.0, 0.0};
            for (std::size_t k = 0; k < 4; ++k) {
                at.radius_px += 0.25 * (tag.seen_px[k] - calibration.camera.principal_point_px).norm();
                at.square_px2 += 0.25 * tag.error_px[k].squaredNorm();
            }
            if (at.square_px2 < std::numeric_limits<double>::infinity()) tags.push_back(at);
        }
    std::ranges::sort(tags, {}, &Tag::radius_px);
    const std::size_t half = tags.size() / 2;
    if (half < 4) return {0.0, 0.0, false};
    double inner = 0.0, outer = 0.0;
    for (std::size_t k = 0; k < half; ++k) {
        inner += tags[k].square_px2 / static_cast<double>(half);
        outer += tags[tags.size() - 1 - k].square_px2 / static_cast<double>(half);
    }
    constexpr double by_chance = 1e-3;
    const auto freedom = static_cast<double>(half);
    return {std::sqrt(inner), std::sqrt(outer),
            outer > mean_square_ratio_bound(freedom, freedom, by_chance) * inner};
}

/// Largest difference of a number of the lens in standard errors of `asked`.
double most_moved(const CameraCalibration& other, const CameraCalibration& asked) {
    const Lens from = lens_of(asked.camera), to = lens_of(other.camera);
    double most = 0.0;
    for (std::size_t k = 0; k < lens_parameters; ++k)
        if (asked.fitted[k])
            most = std::max(most, std::abs(to[k] - from[k]) / asked.std_of(static_cast<LensParameter>(k)));
    return most;
}

/// A calibration that was tried and explains the corners well.
bool fits(const std::optional<CameraCalibration>& tried, const CameraCalibration& asked,
          const CalibrationLimits& limits) {
    return tried && tried->rms_px <= limits.most_rms_px && explains_better(*tried, asked);
}

/// The gap between neighbouring tags as a fraction of their side, if the sides of all tags are `tag_scale`
/// times the stated ones.
std::optional<double> spacing_of(const std::vector<PlateTag>& target, double tag_scale) {
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (const PlateTag& tag : target)
        if (tag.id != target.front().id)
            nearest_mm = std::min(nearest_mm, (tag.centre_mm - target.front().centre_mm).norm());
    const double spacing = nearest_mm / (tag_scale * target.front().side_mm) - 1.0;
    if (!std::isfinite(spacing)) return std::nullopt;
    return spacing;
}

/// What was tried, in words that follow "that", and what came of it.
struct Explanation {
    double rms_px;
    std::string text;
};

/// Of the explanations by lenses of one model those that fit. `asked`: as it was asked for.
void add_explanations(const CameraCalibration& asked, LensModel by, const CalibrationLimits& limits,
                      const std::vector<PlateTag>& target, std::vector<Explanation>& explanations) {
    const LensModel model = asked.camera.distortion.model;
    const std::string and_lens =
        by == model ? "" : fmt::format(", with a lens of the model {}, --lens {},", name_of(by), name_of(by));
    const auto fit_text = [&](const CameraCalibration& found) {
        return fmt::format("fits: {:.2g} px in place of {:.3g} px", found.rms_px, asked.rms_px);
    };
    if (const auto scaled = with_free_tag_scale(asked, by); fits(scaled, asked, limits)) {
        const auto said = spacing_of(target, 1.0), found = spacing_of(target, scaled->tag_scale);
        if (said && found)
            explanations.push_back(
                {scaled->rms_px,
                 fmt::format("the gap between the tags is {:.3g} of their side, not {:.3g}: that{} {}: "
                             "is the target's spacing right?",
                             *found, *said, and_lens, fit_text(*scaled))});
    }
    if (const auto grid = with_other_columns(asked, target, by);
        grid && fits(grid->calibration, asked, limits))
        explanations.push_back(
            {grid->calibration.rms_px,
             fmt::format("the tags stand in rows of {}, not of {}: that{} {}: is the target's grid right?",
                         grid->columns, columns_of(target).value_or(0), and_lens,
                         fit_text(grid->calibration))});
}

std::string other_lens_text(const CameraCalibration& asked, const CameraCalibration& other) {
    const LensModel model = asked.camera.distortion.model, by = other.camera.distortion.model;
    const Growth growth = growth_of(asked);
    const std::string grows =
        growth.is_real
            ? fmt::format(", whose errors grow from {:.2g} px in the inner half to {:.2g} px in the outer",
                          growth.inner_px, growth.outer_px)
            : "";
    return fmt::format(
        "a lens of the model {} does not describe this camera{}; one of the model {} fits: {:.2g} px in "
        "place of {:.3g} px: --lens {}",
        name_of(model), grows, name_of(by), other.rms_px, asked.rms_px, name_of(by));
}

/// Why the corners are explained badly: the explanation that was tried and explains them best.
std::string cause_of_misfit(const CameraCalibration& calibration, const CalibrationLimits& limits,
                            const std::vector<PlateTag>& target) {
    const LensModel model = calibration.camera.distortion.model, other = other_model(model);
    const CameraCalibration asked = with_model(calibration, model).value_or(calibration);
    std::vector<Explanation> explanations;
    if (const auto other_lens = with_model(calibration, other); fits(other_lens, asked, limits))
        explanations.push_back({other_lens->rms_px, other_lens_text(asked, *other_lens)});
    add_explanations(asked, model, limits, target, explanations);
    if (explanations.empty()) add_explanations(asked, other, limits, target, explanations);
    if (!explanations.empty()) return std::ranges::min_element(explanations, {}, &Explanation::rms_px)->text;
    const auto without = without_worst_view(asked, model);
    if (without && without->calibration.rms_px <= limits.most_rms_px)
        return fmt::format("without {} the rest fits: {:.2g} px", without->name, without->calibration.rms_px);
    const double noisy = 1.0 + 3.0 * std::sqrt(2.0 / calibration.freedom);
    if (calibration.misfit <= noisy) return "the corners' own noise explains it";
    return fmt::format(
        "neither a lens of the model {}, nor tags of another size or in rows of another number, nor a "
        "single view explains it",
        name_of(other));
}

}  // namespace

std::vector<std::string> shortcomings(const CameraCalibration& calibration, const CalibrationLimits& limits,
                                      const std::vector<PlateTag>& target) {
    std::vector<std::string> reasons;
    const double focal_px = calibration.camera.focal_px;
    const double focal_std_px = calibration.std_of(focal);
    const bool explained = calibration.rms_px <= limits.most_rms_px;
    if (!explained) {
        reasons.push_back(fmt::format("the reprojection error is too large: {:.3g} px, more than {:g} px; {}",
                                      calibration.rms_px, limits.most_rms_px,
                                      cause_of_misfit(calibration, limits, target)));
    } else if (!(focal_std_px <= limits.most_focal_std * focal_px)) {
        reasons.push_back(fmt::format(
            "the focal length is not determined: {:.5g} +- {:.2g} px, more than {:g} %{}", focal_px,
            focal_std_px, 100.0 * limits.most_focal_std, focal_advice(calibration, limits)));
    }
    const double share = coverage_of(calibration).share;
    if (share < limits.least_coverage)
        reasons.push_back(
            fmt::format("the target was seen in {:.0f} % of the image only, less than {:.0f} %: distortion "
                        "is not known in "
                        "the rest",
                        100.0 * share, 100.0 * limits.least_coverage));
    // Where the lens does not explain the views, their places are not known.
    const int different = explained ? different_views(calibration) : limits.least_views;
    if (different < limits.least_views)
        reasons.push_back(fmt::format("{} of {} views differ from each other, fewer than {}", different,
                                      calibration.views.size(), limits.least_views));
    return reasons;
}

std::vector<std::string> notes_on(const CameraCalibration& calibration) {
    std::vector<std::string> notes;
    const LensModel model = calibration.camera.distortion.model, other = other_model(model);
    const auto asked = with_model(calibration, model);
    if (!asked) return notes;
    const auto tried = with_model(calibration, other);
    if (tried && explains_better(*tried, *asked))
        notes.push_back(fmt::format(
            "a lens of the other model, {}, explains the same corners better, {:.3g} px in place of "
            "{:.3g} px: the standard errors do not hold what {} misses: --lens {}",
            name_of(other), tried->rms_px, asked->rms_px, name_of(model), name_of(other)));
    const auto scaled = with_tag_scale_near(calibration, model);
    if (scaled && explains_better(*scaled, *asked) && most_moved(*scaled, *asked) > 1.0)
        notes.push_back(fmt::format(
            "tags whose sides are {:.4g} times as long beside their distances as the target has them "
            "explain the same corners better, {:.3g} px in place of {:.3g} px, and move the lens by "
            "{:.2g} standard errors: is the target printed as said?",
            scaled->tag_scale, scaled->rms_px, asked->rms_px, most_moved(*scaled, *asked)));
    return notes;
}

}  // namespace fidservo::calib
