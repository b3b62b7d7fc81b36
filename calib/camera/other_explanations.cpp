// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/other_explanations.h"

#include "calib/camera/calibration_start.h"
#include "calib/camera/plane_pose.h"
#include "calib/significance.h"
#include "core/median.h"
#include "vision/tags/tag_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace fidservo::calib {
namespace {

CameraCalibrationOptions options_of(const CameraCalibration& asked, LensModel model) {
    CameraCalibrationOptions options;
    options.width_px = asked.camera.width_px;
    options.height_px = asked.camera.height_px;
    options.model = model;
    options.fit_focal_ratio = asked.fitted[focal_ratio];
    return options;
}

std::optional<CameraCalibration> calibrated(const std::vector<TargetView>& views,
                                            const CameraCalibrationOptions& options) {
    Result<CameraCalibration> found = calibrate_camera(views, options);
    if (!found) return std::nullopt;
    return *found;
}

/// Some of the views, of those that show most, to compare descriptions of the target roughly.
std::vector<TargetView> few_of(std::vector<TargetView> views) {
    constexpr std::size_t enough = 4;
    std::ranges::stable_sort(views, std::ranges::greater{},
                             [](const TargetView& view) { return view.tags.size(); });
    if (views.size() > enough) views.resize(enough);
    return views;
}

/// Median distance, px, of the corners from what the nearest perspective picture of the target shows.
double perspective_error_px(const CameraGeometry& plain, const std::vector<TargetView>& views) {
    std::vector<double> errors_px;
    for (const TargetView& view : views) {
        const auto homography = target_homography(plain, view);
        if (!homography) return std::numeric_limits<double>::infinity();
        for (const TagSight& sight : view.tags) {
            const auto corners_mm = vision::corners_mm(sight.printed);
            for (std::size_t k = 0; k < 4; ++k) {
                const Eigen::Vector2d shown = (*homography * corners_mm[k].homogeneous()).hnormalized();
                errors_px.push_back(
                    (plain.principal_point_px + shown - sight.seen.detection.corners_px[k]).norm());
            }
        }
    }
    return errors_px.empty() ? std::numeric_limits<double>::infinity() : median_of(errors_px);
}

/// The least rough error, px, of an equidistant lens over a coarse grid of focal lengths, which suffices to
/// compare descriptions of a target.
double fisheye_error_px(const CameraCalibrationOptions& options, const std::vector<TargetView>& views) {
    constexpr double step = 1.5;
    const double width_px = std::max(options.width_px, options.height_px);
    double least_px = std::numeric_limits<double>::infinity();
    for (double focal_px = 0.2 * width_px; focal_px < 4.0 * width_px; focal_px *= step)
        least_px = std::min(least_px, rough_error_px(plain_lens(options, focal_px), views));
    return least_px;
}

double roughly_px(const std::vector<TargetView>& views, const CameraCalibrationOptions& options) {
    if (options.model == LensModel::equidistant) return fisheye_error_px(options, views);
    return perspective_error_px(plain_lens(options, options.width_px), views);
}

std::vector<TargetView> with_sides(std::vector<TargetView> views, double scale) {
    for (TargetView& view : views)
        for (TagSight& sight : view.tags) sight.printed.side_mm *= scale;
    return views;
}

/// Ids that count along rows of so many tags, from the first tag of the target.
struct Grid {
    PlateTag first;
    Eigen::Vector2d along_mm, across_mm;
    int columns;

    Eigen::Vector2d centre_mm(int id) const {
        const int k = id - first.id;
        return first.centre_mm + (k % columns) * along_mm + (k / columns) * across_mm;
    }
};

std::optional<Grid> grid_of(std::vector<PlateTag> target) {
    constexpr double rounding = 1e-6;
    if (target.size() < 3) return std::nullopt;
    std::ranges::sort(target, {}, &PlateTag::id);
    const PlateTag& first = target.front();
    const Eigen::Vector2d along_mm = target[1].centre_mm - first.centre_mm;
    const auto next_row = std::ranges::find_if(target, [&](const PlateTag& tag) {
        const Eigen::Vector2d step = tag.centre_mm - first.centre_mm;
        return std::abs(along_mm.x() * step.y() - along_mm.y() * step.x()) >
               rounding * along_mm.squaredNorm();
    });
    if (next_row == target.end()) return std::nullopt;
    const Grid grid{first, along_mm, next_row->centre_mm - first.centre_mm,
                    static_cast<int>(next_row - target.begin())};
    for (const PlateTag& tag : target)
        if (!((grid.centre_mm(tag.id) - tag.centre_mm).norm() <= rounding * along_mm.norm()))
            return std::nullopt;
    return grid;
}

std::vector<TargetView> laid_out(std::vector<TargetView> views, const Grid& grid) {
    for (TargetView& view : views)
        for (TagSight& sight : view.tags) sight.printed.centre_mm = grid.centre_mm(sight.printed.id);
    return views;
}

/// chi^2 of the tags that both of two calibrations of the same views use.
struct Comparison {
    double chi2_other = 0.0, chi2_asked = 0.0;
    int measured = 0;
    double misfit() const { return std::max(1.0, chi2_other / measured); }
};

Comparison compared(const CameraCalibration& other, const CameraCalibration& asked) {
    Comparison both;
    for (std::size_t view = 0; view < std::min(asked.views.size(), other.views.size()); ++view)
        for (std::size_t tag = 0;
             tag < std::min(asked.views[view].tags.size(), other.views[view].tags.size()); ++tag) {
            const SightResidual& a = asked.views[view].tags[tag];
            const SightResidual& b = other.views[view].tags[tag];
            if (!a.used || !b.used) continue;
            const CornerWeights weights = corner_weights(asked.seen[view].tags[tag].seen.covariance_px2, 0.0);
            const auto chi2 = [&](const SightResidual& of) {
                Eigen::Matrix<double, 8, 1> error;
                for (int k = 0; k < 4; ++k)
                    error.segment<2>(2 * k) = of.error_px[static_cast<std::size_t>(k)];
                return (weights.whiten * error).squaredNorm();
            };
            both.chi2_asked += chi2(a);
            both.chi2_other += chi2(b);
            both.measured += weights.rank;
        }
    return both;
}

}  // namespace

LensModel other_model(LensModel model) {
    return model == LensModel::plumb_bob ? LensModel::equidistant : LensModel::plumb_bob;
}

bool explains_better(const CameraCalibration& other, const CameraCalibration& asked) {
    constexpr double by_chance = 1e-3;
    const Comparison both = compared(other, asked);
    if (both.measured == 0) return false;
    const auto numbers = static_cast<double>(coefficients_of(other.camera.distortion.model));
    return both.chi2_asked - both.chi2_other > chi_square_bound(numbers, by_chance) * both.misfit();
}

void count_other_model(CameraCalibration& calibration) {
    const auto other = with_model(calibration, other_model(calibration.camera.distortion.model));
    if (!other) return;
    const Comparison both = compared(*other, calibration);
    if (both.measured == 0) return;
    const double odds = std::exp(0.5 * (both.chi2_asked - both.chi2_other) / both.misfit());
    const double weight = std::isfinite(odds) ? odds / (1.0 + odds) : 1.0;
    const Lens here = lens_of(calibration.camera), there = lens_of(other->camera);
    Eigen::Matrix<double, lens_parameters, 1> way = Eigen::Matrix<double, lens_parameters, 1>::Zero();
    for (const LensParameter shared : {focal, centre_u, centre_v, focal_ratio})
        if (calibration.fitted[shared]) way(shared) = there[shared] - here[shared];
    calibration.covariance += weight * way * way.transpose();
}

std::optional<CameraCalibration> with_model(const CameraCalibration& asked, LensModel model) {
    CameraCalibrationOptions options = options_of(asked, model);
    if (model == asked.camera.distortion.model) options.start = asked.camera;
    if (auto found = calibrated(asked.seen, options); found || !options.start) return found;
    options.start.reset();
    return calibrated(asked.seen, options);
}

std::optional<CameraCalibration> with_free_tag_scale(const CameraCalibration& asked, LensModel model) {
    constexpr double smallest = 0.3, largest = 3.0, step = 1.08;
    CameraCalibrationOptions options = options_of(asked, model);
    const std::vector<TargetView> few = few_of(asked.seen);
    double best = 1.0, least_px = std::numeric_limits<double>::infinity();
    for (double scale = smallest; scale < largest; scale *= step) {
        const double error_px = roughly_px(with_sides(few, scale), options);
        if (!(error_px < least_px)) continue;
        least_px = error_px;
        best = scale;
    }
    options.fit_tag_scale = true;
    auto found = calibrated(with_sides(asked.seen, best), options);
    if (found) found->tag_scale *= best;
    return found;
}

std::optional<CameraCalibration> with_tag_scale_near(const CameraCalibration& asked, LensModel model) {
    CameraCalibrationOptions options = options_of(asked, model);
    options.fit_tag_scale = true;
    if (model == asked.camera.distortion.model) options.start = asked.camera;
    return calibrated(asked.seen, options);
}

std::optional<int> columns_of(const std::vector<PlateTag>& target) {
    const auto grid = grid_of(target);
    if (!grid) return std::nullopt;
    return grid->columns;
}

std::optional<OtherGrid> with_other_columns(const CameraCalibration& asked,
                                            const std::vector<PlateTag>& target, LensModel model) {
    constexpr int most_columns = 40;
    const auto said = grid_of(target);
    if (!said) return std::nullopt;
    const CameraCalibrationOptions options = options_of(asked, model);
    const std::vector<TargetView> few = few_of(asked.seen);
    Grid best = *said;
    double least_px = std::numeric_limits<double>::infinity();
    for (int columns = 1; columns <= most_columns; ++columns) {
        Grid tried = *said;
        tried.columns = columns;
        if (columns == said->columns) continue;
        const double error_px = roughly_px(laid_out(few, tried), options);
        if (!(error_px < least_px)) continue;
        least_px = error_px;
        best = tried;
    }
    auto found = calibrated(laid_out(asked.seen, best), options);
    if (!found) return std::nullopt;
    return OtherGrid{best.columns, std::move(*found)};
}

std::optional<WithoutView> without_worst_view(const CameraCalibration& asked, LensModel model) {
    if (asked.views.size() <= 3) return std::nullopt;
    const auto worst = std::ranges::max_element(asked.views, {}, &ViewFit::rms_px) - asked.views.begin();
    std::vector<TargetView> rest = asked.seen;
    const std::string name = rest[static_cast<std::size_t>(worst)].name;
    rest.erase(rest.begin() + worst);
    auto found = calibrated(rest, options_of(asked, model));
    if (!found) return std::nullopt;
    return WithoutView{name, std::move(*found)};
}

}  // namespace fidservo::calib
