// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/stage_values.h"

#include "core/rig.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo {

std::vector<StageValue> stage_values(const Rig& rig, const StageNumbers& numbers) {
    const calib::StageMap& map = numbers.map;
    const CameraGeometry& camera = map.camera;
    const CameraGeometry& file = rig.camera.value().geometry;
    const HallParameters& hall = rig.micro.value().hall;
    const calib::HallCurve& curve = numbers.hall;
    const double scale = map.scale_px_per_mm();
    return {
        {"scale", "px/mm", scale, scale * map.relative_scale_std(), false, 0.0},
        {"camera.distance_mm", "mm", camera.distance_mm,
         std::sqrt(map.camera_covariance(camera_distance, camera_distance)), true, file.distance_mm},
        {"camera.rotation_rad", "rad", camera.rotation_rad, map.std(calib::map_rotation), true,
         file.rotation_rad},
        {"camera.tilt_rad[0]", "rad", camera.tilt_rad.x(), map.std(calib::map_tilt_u), true,
         file.tilt_rad.x()},
        {"camera.tilt_rad[1]", "rad", camera.tilt_rad.y(), map.std(calib::map_tilt_v), true,
         file.tilt_rad.y()},
        {"camera.axis_rad[0]", "rad", camera.axis_rad.x(), map.std(calib::map_axis_y), true,
         file.axis_rad.x()},
        {"camera.axis_rad[1]", "rad", camera.axis_rad.y(), map.std(calib::map_axis_z), true,
         file.axis_rad.y()},
        {"camera.distortion[0]", "", camera.distortion.k1, map.std(calib::map_k1), true, file.distortion.k1},
        {"macro.encoder_resolution_mm", "mm/count", numbers.encoder.resolution_mm,
         numbers.encoder.resolution_std_mm, true, rig.macro.encoder_resolution_mm},
        {"plate_mm_per_hall_mm", "", numbers.hall_scale, numbers.hall_scale_std, false, 0.0},
        {"micro.hall.mid_V", "V", curve.hall.mid_V, curve.mid_std_V, true, hall.mid_V},
        {"micro.hall.span_V", "V", curve.hall.span_V, curve.span_std_V, true, hall.span_V},
        {"micro.hall.centre_mm", "mm", curve.hall.centre_mm, curve.centre_std_mm, true, hall.centre_mm},
        {"micro.hall.cubic", "", curve.hall.cubic, curve.cubic_std, true, hall.cubic}};
}

std::string with_std(const StageValue& value) {
    if (!std::isfinite(value.std) || value.std <= 0.0) return fmt::format("{:.6g}", value.value);
    const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(value.std))), 0, 12);
    return fmt::format("{:.{}f} +- {:.{}f}", value.value, decimals, value.std, decimals);
}

std::vector<std::string> stage_notes(const StageNumbers& numbers) {
    std::vector<std::string> notes{
        fmt::format("{} pictures, corners {:.4f} px r.m.s. from the map; mean square in variances of the "
                    "noise {:.3f}",
                    numbers.mapped.size(), numbers.map.residual_rms_px, numbers.map.misfit)};
    if (!numbers.map.fits)
        notes.emplace_back(
            "the pictures differ from the map by more than noise: its standard errors are widened "
            "accordingly");
    if (!numbers.encoder.fits)
        notes.push_back(fmt::format(
            "the encoder's counts are not evenly spaced: a stand lies {:.2f} counts outside its own",
            numbers.encoder.excess_count));
    notes.push_back(fmt::format("platform by the fitted Hall curve: {:.3f} um r.m.s. from the camera",
                                1e3 * numbers.platform_error_mm));
    return notes;
}

}  // namespace fidservo
