// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/calibrate/stage_numbers.h"

#include "calib/dense.h"
#include "core/failure.h"
#include "core/rig.h"
#include "core/units.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace fidservo {

namespace {

bool of_platform(StageMove move) {
    return move == StageMove::extended || move == StageMove::platform;
}

/// A stand of the sweep: where the camera saw the platform, from where it is relaxed.
struct PlatformPlace {
    const StageShot* shot;
    double reference_mm;
};

Result<std::vector<PlatformPlace>> platform_places(StageNumbers& numbers) {
    std::vector<PlatformPlace> places;
    bool relaxed = false;
    for (std::size_t i = 0; i < numbers.mapped.size(); ++i) {
        const StageShot& shot = *numbers.mapped[i];
        if (!of_platform(shot.move)) continue;
        if (shot.move == StageMove::extended) {
            numbers.extended_s_mm = numbers.map.s_mm[i];
            numbers.extended_count = shot.count;
            relaxed = true;
        }
        if (relaxed && shot.count == numbers.extended_count)
            places.push_back({&shot, numbers.map.s_mm[i] - numbers.extended_s_mm});
    }
    if (!relaxed) return failure(Reason::not_identifiable, "the relaxed platform was not seen");
    return places;
}

Status fit_hall(const Rig& rig, StageNumbers& numbers, const std::vector<PlatformPlace>& places) {
    const MicroParameters& micro = rig.micro.value();
    std::vector<calib::HallSample> samples;
    for (const PlatformPlace& place : places)
        for (const int adc : place.shot->hall_adc)
            samples.push_back({place.reference_mm, static_cast<double>(adc)});
    const auto curve = calib::fit_hall_curve(micro.hall, samples, micro.low_mm, micro.high_mm);
    if (!curve) return failure(curve.error().reason, "Hall sensor: " + curve.error().text);
    if (curve->refused) return failure(curve->refused->reason, "Hall sensor: " + curve->refused->text);
    numbers.hall = *curve;

    constexpr double curve_values = 4.0, line_values = 2.0;
    const auto n = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixX2d line(n, 2);
    Eigen::VectorXd reference_mm(n);
    double squares = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const PlatformPlace& place = places[static_cast<std::size_t>(i)];
        line.row(i) << 1.0, hall_position_mm_of_adc(micro.hall, place.shot->hall_mean());
        reference_mm(i) = place.reference_mm;
        squares +=
            std::pow(hall_position_mm_of_adc(curve->hall, place.shot->hall_mean()) - place.reference_mm, 2.0);
    }
    const Eigen::Vector2d fit = calib::least_squares(line, reference_mm);
    const double variance =
        (line * fit - reference_mm).squaredNorm() / (static_cast<double>(n) - line_values);
    numbers.hall_scale = fit(1);
    numbers.hall_scale_std = std::sqrt(variance * (line.transpose() * line).inverse()(1, 1));
    numbers.platform_error_mm = std::sqrt(squares / (static_cast<double>(n) - curve_values));
    return {};
}

Status fit_encoder(StageNumbers& numbers) {
    std::vector<calib::EncoderStand> stands;
    for (std::size_t i = 0; i < numbers.mapped.size(); ++i) {
        const StageShot& shot = *numbers.mapped[i];
        if (of_platform(shot.move) && shot.move != StageMove::extended) continue;  // one stand is one stand
        stands.push_back({shot.count,
                          numbers.map.s_mm[i] - hall_position_mm_of_adc(numbers.hall.hall, shot.hall_mean()),
                          std::hypot(numbers.map.s_std_mm[i], numbers.platform_error_mm)});
    }
    const auto scale = calib::fit_encoder_scale(stands);
    if (!scale) return failure(scale.error().reason, "encoder: " + scale.error().text);
    numbers.encoder = *scale;
    return {};
}

std::vector<calib::StageView> views_of(const std::vector<StageShot>& shots) {
    std::vector<calib::StageView> views;
    for (const StageShot& shot : shots)
        if (!is_fresh(shot)) views.push_back(shot.tags);
    return views;
}

}  // namespace

bool is_fresh(const StageShot& shot) {
    return shot.move == StageMove::fresh_travel || shot.move == StageMove::fresh_platform;
}

StandResidual residual_of(const StageNumbers& numbers, const StageShot& shot, double s_mm) {
    StandResidual residual{shot.move, s_mm, hall_position_mm_of_adc(numbers.hall.hall, shot.hall_mean()),
                           std::nan(""), std::nan("")};
    const bool platform_alone = of_platform(shot.move) || shot.move == StageMove::fresh_platform;
    if (platform_alone && shot.count == numbers.extended_count)
        residual.hall_error_mm = residual.platform_mm - (s_mm - numbers.extended_s_mm);
    if (!platform_alone) {
        const double carriage_mm = s_mm - residual.platform_mm;
        residual.count_error =
            shot.count - (carriage_mm - numbers.encoder.zero_mm) / numbers.encoder.resolution_mm;
    }
    return residual;
}

Result<StageNumbers> stage_numbers(const Rig& rig, std::vector<StageShot>& shots) {
    constexpr int refinements = 2;
    const CameraParameters& camera = rig.camera.value();
    auto map = calib::fit_stage_map(camera.geometry, views_of(shots));
    const bool have_images = std::ranges::none_of(shots, [](const StageShot& s) { return s.image.empty(); });
    for (int k = 0; k < refinements && have_images && map; ++k) {
        refine_again(camera, map->camera, shots);
        map = calib::fit_stage_map(camera.geometry, views_of(shots));
    }
    if (!map) return tl::make_unexpected(map.error());
    StageNumbers numbers{};
    for (const StageShot& shot : shots)
        if (!is_fresh(shot)) numbers.mapped.push_back(&shot);
    numbers.map = std::move(*map);
    const auto places = platform_places(numbers);
    if (!places) return tl::make_unexpected(places.error());
    if (auto fitted = fit_hall(rig, numbers, *places); !fitted) return tl::make_unexpected(fitted.error());
    if (auto fitted = fit_encoder(numbers); !fitted) return tl::make_unexpected(fitted.error());
    for (std::size_t i = 0; i < numbers.mapped.size(); ++i)
        numbers.residuals.push_back(residual_of(numbers, *numbers.mapped[i], numbers.map.s_mm[i]));
    return numbers;
}

}  // namespace fidservo
