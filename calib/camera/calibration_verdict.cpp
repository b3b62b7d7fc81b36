#include "calib/camera/calibration_verdict.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

std::vector<std::string> shortcomings(const CameraCalibration& calibration, const CalibrationLimits& limits) {
    std::vector<std::string> reasons;
    const double focal_px = calibration.camera.focal_px;
    const double focal_std_px = calibration.std_of(focal);
    if (!(focal_std_px <= limits.most_focal_std * focal_px))
        reasons.push_back(fmt::format(
            "the focal length is not determined: {:.5g} +- {:.2g} px, more than {:g} %; the target's "
            "tilt differs by {:.2g} degrees at most between the views, which is too little to "
            "separate focal length from distance: tilt it more",
            focal_px, focal_std_px, 100.0 * limits.most_focal_std, widest_tilt_rad(calibration) / deg));
    if (!(calibration.rms_px <= limits.most_rms_px))
        reasons.push_back(fmt::format("the reprojection error is too large: {:.3g} px, more than {:g} px",
                                      calibration.rms_px, limits.most_rms_px));
    const double share = coverage_of(calibration).share;
    if (share < limits.least_coverage)
        reasons.push_back(
            fmt::format("the target was seen in {:.0f} % of the image only, less than {:.0f} %: distortion "
                        "is not known in "
                        "the rest",
                        100.0 * share, 100.0 * limits.least_coverage));
    const int different = different_views(calibration);
    if (different < limits.least_views)
        reasons.push_back(fmt::format("{} of {} views differ from each other, fewer than {}", different,
                                      calibration.views.size(), limits.least_views));
    return reasons;
}

}  // namespace fidservo::calib
