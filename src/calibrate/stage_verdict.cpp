// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/stage_verdict.h"

#include "calib/significance.h"
#include "core/rig.h"
#include "core/units.h"

#include <algorithm>
#include <cmath>

namespace fidservo {

namespace {

/// Of each test: three in a calibration of minutes, which chance alone is not to throw away.
constexpr double false_failure = 0.001;

FreshTest test_pictures(const StageNumbers& numbers, std::span<const StageShot> shots) {
    double squares = 0.0, promised = 0.0, chi_square = 0.0, freedom = 0.0, worst_normalised = 0.0;
    FreshTest test{"tags in the image", "px", 0, 0.0, 0.0, 0.0, 0.0, false};
    double worst_std = 0.0;
    for (const StageShot& shot : shots) {
        if (!is_fresh(shot)) continue;
        const calib::ViewCheck check = calib::check_view(numbers.map, shot.tags);
        const std::size_t coordinates = 8 * shot.tags.size();
        test.errors += coordinates;
        squares += static_cast<double>(coordinates) * check.rms_px * check.rms_px;
        promised += static_cast<double>(coordinates) * check.promised_rms_px * check.promised_rms_px;
        chi_square += check.chi_square;
        freedom += check.freedom;
        if (check.worst_normalised > worst_normalised) {
            test.worst = check.worst_px;
            worst_normalised = check.worst_normalised;
            worst_std = check.worst_px / check.worst_normalised;
        }
    }
    if (test.errors == 0) return test;
    const auto n = static_cast<double>(test.errors);
    test.rms = std::sqrt(squares / n);
    test.promised_rms = std::sqrt(promised / n);
    const double bound = calib::normal_bound(0.25 * false_failure / n);
    test.allowed_worst = bound * worst_std;
    test.passed =
        chi_square <= calib::chi_square_bound(freedom, 0.5 * false_failure) && worst_normalised <= bound;
    return test;
}

FreshTest test_platform(const StageNumbers& numbers, std::span<const StageShot> shots) {
    constexpr double curve_values = 4.0;
    const auto fitted = static_cast<double>(std::ranges::count_if(
        numbers.residuals, [](const StandResidual& r) { return std::isfinite(r.hall_error_mm); }));
    const double promised = numbers.platform_error_mm * std::sqrt(1.0 + curve_values / fitted);
    FreshTest test{"platform by Hall sensor", "um", 0, 0.0, um_from_mm(promised), 0.0, 0.0, false};
    double squares = 0.0;
    for (const StageShot& shot : shots) {
        if (shot.move != StageMove::fresh_platform) continue;
        const double error_mm =
            residual_of(numbers, shot, calib::check_view(numbers.map, shot.tags).s_mm).hall_error_mm;
        if (!std::isfinite(error_mm)) continue;
        ++test.errors;
        squares += error_mm * error_mm;
        test.worst = std::max(test.worst, um_from_mm(std::abs(error_mm)));
    }
    if (test.errors == 0) return test;
    const auto n = static_cast<double>(test.errors);
    const double freedom = fitted - curve_values;
    test.rms = um_from_mm(std::sqrt(squares / n));
    test.allowed_worst =
        test.promised_rms * std::sqrt(calib::mean_square_ratio_bound(1.0, freedom, 0.5 * false_failure / n));
    const double allowed_ratio = calib::mean_square_ratio_bound(n, freedom, 0.5 * false_failure);
    test.passed =
        std::pow(test.rms / test.promised_rms, 2.0) <= allowed_ratio && test.worst <= test.allowed_worst;
    return test;
}

/// Where within a count the carriage stands is not chance: the drive often stops as soon as the count is
/// reached, at its edge. What is promised is half a count at most, also of the r.m.s.
FreshTest test_encoder(const StageNumbers& numbers, std::span<const StageShot> shots) {
    const double count_mm = std::abs(numbers.encoder.resolution_mm);
    FreshTest test{"carriage by encoder", "um", 0, 0.0, 0.0, 0.0, 0.0, false};
    double squares = 0.0, widest_mm = 0.0;
    for (const StageShot& shot : shots) {
        if (shot.move != StageMove::fresh_travel) continue;
        const double s_mm = calib::check_view(numbers.map, shot.tags).s_mm;
        const double error_mm = count_mm * residual_of(numbers, shot, s_mm).count_error;
        ++test.errors;
        squares += error_mm * error_mm;
        test.worst = std::max(test.worst, um_from_mm(std::abs(error_mm)));
        const double slope_mm =
            numbers.encoder.resolution_std_mm * (s_mm - numbers.encoder.middle_mm) / count_mm;
        widest_mm = std::max(widest_mm,
                             std::hypot(numbers.encoder.middle_std_mm, slope_mm, numbers.platform_error_mm));
    }
    if (test.errors == 0) return test;
    const auto n = static_cast<double>(test.errors);
    test.rms = um_from_mm(std::sqrt(squares / n));
    test.promised_rms = um_from_mm(std::hypot(0.5 * count_mm, widest_mm));
    test.allowed_worst =
        um_from_mm(0.5 * count_mm + calib::normal_bound(0.5 * false_failure / n) * widest_mm);
    test.passed = test.worst <= test.allowed_worst;
    return test;
}

calib::Expectation of_camera_scale(const CameraGeometry& file, const calib::StageMap& map) {
    const double length = std::sqrt(1.0 + file.axis_rad.squaredNorm());
    const double expected = file.focal_px / (file.distance_mm - map.middle_mm * file.axis_rad.y() / length);
    return {"camera scale",
            "px/mm",
            expected,
            map.scale_px_per_mm(),
            map.scale_px_per_mm() * map.relative_scale_std(),
            1e-4 * expected};
}

}  // namespace

std::vector<FreshTest> test_fresh(const StageNumbers& numbers, std::span<const StageShot> shots) {
    return {test_pictures(numbers, shots), test_platform(numbers, shots), test_encoder(numbers, shots)};
}

std::vector<calib::Expectation> expectations(const Rig& rig, const StageNumbers& numbers) {
    const CameraGeometry& file = rig.camera.value().geometry;
    const calib::StageMap& map = numbers.map;
    const CameraGeometry& found = map.camera;
    const HallParameters& hall = rig.micro.value().hall;
    const calib::HallCurve& curve = numbers.hall;
    const double count_mm = rig.macro.encoder_resolution_mm;
    return {of_camera_scale(file, map),
            {"camera rotation", "rad", file.rotation_rad + file.axis_rad.x(), map.image_axis_rad(),
             map.image_axis_std_rad(), 2e-4},
            {"camera tilt u", "rad", file.tilt_rad.x(), found.tilt_rad.x(), map.std(calib::map_tilt_u), 2e-3},
            {"camera tilt v", "rad", file.tilt_rad.y(), found.tilt_rad.y(), map.std(calib::map_tilt_v), 2e-3},
            {"lens distortion k1", "", file.distortion.k1, found.distortion.k1, map.std(calib::map_k1), 0.02},
            {"stage axis in the plate", "rad", file.axis_rad.x(), found.axis_rad.x(),
             map.std(calib::map_axis_y), 2e-4},
            {"stage axis to the plate", "rad", file.axis_rad.y(), found.axis_rad.y(),
             map.std(calib::map_axis_z), 5e-5},
            {"encoder scale", "mm/count", count_mm, numbers.encoder.resolution_mm,
             numbers.encoder.resolution_std_mm, 2e-4 * count_mm},
            {"Hall gain", "V", hall.span_V, curve.hall.span_V, curve.span_std_V, 2e-3 * hall.span_V},
            {"Hall offset", "V", hall.mid_V, curve.hall.mid_V, curve.mid_std_V, 4e-3},
            {"Hall centre", "mm", hall.centre_mm, curve.hall.centre_mm, curve.centre_std_mm, 0.01},
            {"Hall cubic part", "", hall.cubic, curve.hall.cubic, curve.cubic_std, 0.01}};
}

}  // namespace fidservo
