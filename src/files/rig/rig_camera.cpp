// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/rig_camera.h"

#include "core/camera/camera_parameters.h"
#include "core/camera/camera_slopes.h"
#include "src/files/rig/camera_info.h"
#include "src/files/rig/capture_keys.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace fidservo {
namespace {

constexpr NumberRange focal_ratios{0.5, 2.0};
constexpr NumberRange coefficients{-100.0, 100.0};
constexpr NumberRange turn{-std::numbers::pi, std::numbers::pi};
constexpr NumberRange tilts{-0.5, 0.5};
constexpr NumberRange axis_angles{-0.1, 0.1};
constexpr double widest_field_rad = 170.0 * std::numbers::pi / 180.0;

Eigen::Vector2d pair_of(const YamlValue& value, const NumberRange& range) {
    const std::vector<double> numbers = value.numbers(2, range);
    return {numbers[0], numbers[1]};
}

/// An equidistant lens without `distortion` is one of which theta_d = theta.
LensDistortion read_lens(const YamlValue& map) {
    LensDistortion lens;
    if (const auto name = map.find("lens"))
        lens.model = lens_models[name->one_of({name_of(lens_models[0]), name_of(lens_models[1])})];
    if (const auto numbers = map.find("distortion"))
        return distortion_of(lens.model, numbers->numbers(coefficients_of(lens.model), coefficients));
    return lens;
}

CameraGeometry read_own_intrinsics(const YamlValue& map) {
    CameraGeometry camera{.width_px = map.at("width_px").integer(least_image_px, most_image_px),
                          .height_px = map.at("height_px").integer(least_image_px, most_image_px),
                          .focal_px = map.at("focal_px").number(positive),
                          .principal_point_px = pair_of(map.at("principal_point_px"), any_number),
                          .distance_mm = 0.0};
    if (const auto ratio = map.find("focal_ratio")) camera.focal_ratio = ratio->number(focal_ratios);
    check_focal_length(map.at("focal_px"), camera.focal_px, std::max(camera.width_px, camera.height_px));
    camera.distortion = read_lens(map);
    return camera;
}

CameraGeometry read_ros_intrinsics(const YamlValue& map, const YamlValue& info) {
    for (const char* key : intrinsic_camera_keys)
        if (const auto also = map.find(key))
            also->fail("must not be given beside camera_info, which says it");
    return with_intrinsics({0, 0, 0.0, Eigen::Vector2d::Zero(), 0.0}, load_camera_info(info.file()));
}

CameraCovariance read_covariance(const YamlValue& value) {
    const std::vector<double> numbers = value.numbers(camera_triangle_numbers);
    const CameraCovariance covariance =
        from_lower_triangle(std::span<const double, camera_triangle_numbers>(numbers));
    if (!is_covariance(covariance)) value.fail("must be the lower triangle of a covariance matrix");
    return covariance;
}

CameraGeometry read_geometry(const YamlValue& map) {
    const auto info = map.find("camera_info");
    CameraGeometry camera = info ? read_ros_intrinsics(map, *info) : read_own_intrinsics(map);
    camera.distance_mm = map.at("distance_mm").number(positive);
    if (const auto rotation = map.find("rotation_rad")) camera.rotation_rad = rotation->number(turn);
    if (const auto tilt = map.find("tilt_rad")) camera.tilt_rad = pair_of(*tilt, tilts);
    if (const auto axis = map.find("axis_rad")) camera.axis_rad = pair_of(*axis, axis_angles);
    if (!lens_is_one_to_one(camera))
        (info ? *info : map.at(map.find("distortion") ? "distortion" : "lens"))
            .fail(camera.distortion.model == LensModel::plumb_bob
                      ? "a lens of these coefficients would picture one point at two places of the image"
                      : "the picture of such a lens ends before the nearest side of the image: focal_px and "
                        "the "
                        "coefficients leave no direction for what is beyond");
    return camera;
}

}  // namespace

void check_focal_ratio(const YamlValue& value, double focal_ratio) {
    if (focal_ratio < focal_ratios.low || focal_ratio > focal_ratios.high)
        value.fail(fmt::format("f_y / f_x must be of at least {} and at most {}", focal_ratios.low,
                               focal_ratios.high));
}

void check_focal_length(const YamlValue& value, double focal_px, int longer_side_px) {
    const double half_side_px = 0.5 * longer_side_px;
    const double least_px = half_side_px / std::tan(0.5 * widest_field_rad);
    if (focal_px < least_px)
        value.fail(fmt::format(
            "a focal length of {:g} px would see {:.1f} degrees along {} px; allowed: {:.3g} px or "
            "more: it is in px, not in mm or m",
            focal_px, 2.0 * std::atan(half_side_px / focal_px) * 180.0 / std::numbers::pi, longer_side_px,
            least_px));
}

CameraParameters read_rig_camera(const YamlValue& map) {
    map.allow_only({"camera_info",   "width_px",           "height_px",
                    "focal_px",      "focal_ratio",        "principal_point_px",
                    "lens",          "distortion",         "distance_mm",
                    "rotation_rad",  "tilt_rad",           "axis_rad",
                    "frame_rate_hz", "exposure_s",         "full_well_e",
                    "read_noise_e",  "gain_spread",        "blur_px",
                    "latency_s",     "corner_noise_px",    "max_speed_mm_per_s",
                    "capture",       "geometry_covariance"});
    CameraParameters camera{.geometry = read_geometry(map),
                            .frame_rate_hz = map.at("frame_rate_hz").number({0.0, 1e5, true}),
                            .exposure_s = map.at("exposure_s").number(positive),
                            .full_well_e = map.at("full_well_e").number(positive),
                            .read_noise_e = map.at("read_noise_e").number(not_negative),
                            .blur_px = map.at("blur_px").number(not_negative),
                            .latency_s = map.at("latency_s").number(not_negative),
                            .corner_noise_px = map.at("corner_noise_px").number(not_negative),
                            .max_speed_mm_per_s = map.at("max_speed_mm_per_s").number(positive)};
    if (const auto capture = map.find("capture")) (void)read_capture_keys(*capture);
    if (const auto covariance = map.find("geometry_covariance"))
        camera.geometry_covariance = read_covariance(*covariance);
    if (const auto spread = map.find("gain_spread")) camera.gain_spread = spread->number({0.0, 1.0});
    if (camera.exposure_s * camera.frame_rate_hz > 1.0)
        map.at("exposure_s")
            .fail(fmt::format("must not be longer than a frame, {:.6g} s", 1.0 / camera.frame_rate_hz));
    return camera;
}

}  // namespace fidservo
