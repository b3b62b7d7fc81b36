// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/target_images.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fidservo::calib {
namespace {

constexpr std::size_t least_tags = 2;

double shortest_side_px(const TagDetection& tag) {
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 4; ++k)
        shortest = std::min(shortest, (tag.corners_px[(k + 1) % 4] - tag.corners_px[k]).norm());
    return shortest;
}

/// Views of all images; the camera is empty on the first pass.
std::vector<TargetView> views_of(const std::vector<TargetImage>& images, const std::vector<PlateTag>& target,
                                 const vision::GreyNoise& noise, const CameraCalibration* known) {
    std::vector<TargetView> views;
    for (const TargetImage& image : images) {
        vision::RefinementOptions refinement;
        refinement.noise = noise;
        if (known != nullptr) {
            const auto fit = std::ranges::find(known->views, image.name, &ViewFit::name);
            if (fit == known->views.end()) continue;
            refinement.camera = camera_at(known->camera, fit->pose);
        }
        TargetView view = view_of(image, target, refinement);
        if (view.tags.size() >= least_tags) views.push_back(std::move(view));
    }
    return views;
}

/// Largest change of a fitted parameter in standard errors.
double change(const CameraCalibration& before, const CameraCalibration& after) {
    if (before.fitted != after.fitted) return std::numeric_limits<double>::infinity();
    const Lens from = lens_of(before.camera), to = lens_of(after.camera);
    double most = 0.0;
    for (std::size_t k = 0; k < lens_parameters; ++k)
        if (after.fitted[k])
            most = std::max(most, std::abs(to[k] - from[k]) / after.std_of(static_cast<LensParameter>(k)));
    return most;
}

}  // namespace

TargetView view_of(const TargetImage& image, const std::vector<PlateTag>& target,
                   const vision::RefinementOptions& options) {
    constexpr double too_small_px = 24.0;
    TargetView view{.name = image.name, .tags = {}};
    for (const TagDetection& found : image.found) {
        const auto printed = std::ranges::find(target, found.tag_id, &PlateTag::id);
        const bool twice = std::ranges::count(image.found, found.tag_id, &TagDetection::tag_id) > 1;
        if (printed == target.end() || twice) continue;
        if (const auto refined = vision::refine_tag(image.grey, found, options))
            view.tags.push_back({*printed, *refined});
        else if (shortest_side_px(found) < too_small_px)
            view.tags.push_back({*printed, vision::unrefined(found)});
    }
    return view;
}

Result<CameraCalibration> calibrate_camera(const std::vector<TargetImage>& images,
                                           const std::vector<PlateTag>& target,
                                           const ImageCalibrationOptions& options) {
    constexpr int most_passes = 6;
    constexpr double settled = 0.1;
    CameraCalibrationOptions lens = options.lens;
    std::vector<TargetView> seen = views_of(images, target, options.noise, nullptr);
    Result<CameraCalibration> calibration = calibrate_camera(seen, lens);
    for (int pass = 1; pass < most_passes && calibration; ++pass) {
        lens.start = calibration->camera;
        const Result<CameraCalibration> next =
            calibrate_camera(views_of(images, target, options.noise, &*calibration), lens);
        if (!next) return next;
        const double moved = change(*calibration, *next);
        calibration = next;
        if (moved < settled) break;
    }
    if (calibration) calibration->seen = std::move(seen);
    return calibration;
}

}  // namespace fidservo::calib
