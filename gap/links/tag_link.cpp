// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/tag_link.h"

#include "core/demand.h"
#include "core/median.h"
#include "core/rig.h"
#include "gap/evidence/plate_tag.h"
#include "gap/links/between_rows.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fidservo::gap {

namespace {

/// Standard deviation of the carriage's path, as a share of the distance covered since its offset was found.
constexpr double way_share = 0.02;
/// Standard deviation of a position within its count, in counts.
const double hidden_count = 1.0 / std::sqrt(uniform_divisor);

/// The camera's position as a function of the time since the recording's first row.
class CameraPlace {
  public:
    CameraPlace(const TagModel& model, const TagRun& run, const CarriagePath& path,
                const SmoothedReading* reading)
        : model_(model), run_(run), path_(path), reading_(reading) {}

    double s_mm(double at_s) const {
        const Moment at = moment_at(run_.time_s, run_.tick_s, at_s);
        const double y_mm = carriage_mm(path_, at, run_.tick_s);
        return reading_ == nullptr ? y_mm : y_mm + platform_mm(at, at_s);
    }

    /// In the 100 ms before a window: how far the simulation that leads into it is from the path, which is
    /// there faded over from the window before; 0 elsewhere.
    double entering_mm(double at_s) const {
        const std::size_t row = moment_at(run_.time_s, run_.tick_s, at_s).row;
        const double entering = path_.entering_mm[row];
        return std::isfinite(entering) ? entering - path_.position_mm[row] : 0.0;
    }

    /// The position that a frame shows: that in the middle of its exposure or, in images, the mean over it.
    /// For a longer exposure than the rig file's, the difference of the means over the two is added.
    double seen_s_mm(double at_s) const {
        const double extra_s = model_.deviation.extra_exposure_s;
        const double middle_mm = s_mm(at_s);
        const double half_s = 0.5 * model_.exposure_s;
        // Mathematics: the mean over the exposure, by Simpson's rule.
        const double seen_mm =
            run_.is_seen ? (s_mm(at_s - half_s) + 4.0 * middle_mm + s_mm(at_s + half_s)) / 6.0 : middle_mm;
        if (extra_s == 0.0) return seen_mm;
        const auto mean_over = [&](double exposure_s) {
            constexpr int parts = 8;
            double sum = 0.0;
            for (int k = 0; k < parts; ++k) sum += s_mm(at_s + exposure_s * ((k + 0.5) / parts - 0.5));
            return sum / parts;
        };
        return seen_mm + mean_over(model_.exposure_s + extra_s) - mean_over(model_.exposure_s);
    }

  private:
    double platform_mm(const Moment& at, double at_s) const {
        const plant::MicroStageParameters& micro = *model_.micro;
        const plant::HallDisturbance& disturbance = micro.hall_disturbance;
        double voltage_V = reading_lsb(*reading_, at) * hall_lsb_V(micro.hall);
        if (!disturbance.is_none())
            voltage_V -= disturbance.drift_V(at_s) +
                         disturbance.leak_V_per_V * model_.drive_gain * between(reading_->drive_V, at);
        return micro.formulas.act(plant::Port::hall_voltage) ? behind_formulas_mm(voltage_V, at, at_s)
                                                             : hall_position_mm(micro.hall, voltage_V);
    }

    /// The position at which the sensor's curve, with what formulas add to it, gives a voltage.
    double behind_formulas_mm(double voltage_V, const Moment& at, double at_s) const {
        const plant::MicroStageParameters& micro = *model_.micro;
        plant::HallSight seen;
        seen.time_s = at_s;
        seen.room_degC = micro.heater.ambient_degC;
        seen.wire_degC = reading_->wire_degC.empty() ? seen.room_degC : between(reading_->wire_degC, at);
        seen.carriage.drive_V = model_.drive_gain * between(reading_->drive_V, at);
        seen.carriage.place_mm = path_.position_mm[at.row];
        seen.carriage.speed_mm_per_s = path_.velocity_mm_per_s[at.row];
        seen.carriage.shaking.acceleration_mm_per_s2 = path_.acceleration_mm_per_s2[at.row];
        constexpr int rounds = 6;  // formulas are small beside the curve: each round gains a digit or more
        double place_mm = hall_position_mm(micro.hall, voltage_V);
        for (int round = 0; round < rounds; ++round) {
            seen.platform_mm = place_mm;
            place_mm = hall_position_mm(micro.hall, voltage_V - plant::formula_hall_V(micro.formulas, seen));
        }
        return place_mm;
    }

    const TagModel& model_;
    const TagRun& run_;
    const CarriagePath& path_;
    const SmoothedReading* reading_;
};

/// The corners of a tag as a camera at position s sees them.
/// @param beside_mm  displacement of the tag from its stated place
CornerValues seen(const plant::ActualCamera& camera, const TagSighting& sighting, double s_mm,
                  const Eigen::Vector2d& beside_mm = Eigen::Vector2d::Zero()) {
    CornerValues corners;
    for (int c = 0; c < corner_count; ++c)
        corners.segment<2>(2 * c) =
            camera.image_px(sighting.corners_mm[static_cast<std::size_t>(c)] + beside_mm, s_mm);
    return corners;
}

/// The camera at a time and a position.
plant::ActualCamera camera_at(const TagModel& model, double time_s, double s_mm) {
    return plant::geometry_changes(model.deviation)
               ? plant::actual_camera(model.nominal, plant::deviation_at(model.deviation, time_s, s_mm))
               : model.camera;
}

/// d corners / ds, px per mm.
CornerValues seen_slope(const plant::ActualCamera& camera, const TagSighting& sighting, double s_mm) {
    return (seen(camera, sighting, s_mm + trial_mm) - seen(camera, sighting, s_mm - trial_mm)) /
           (2.0 * trial_mm);
}

/// The corners that are predicted for a detection if the carriage's position is off by an offset.
CornerValues predicted(const TagModel& model, const CameraPlace& place, const TagSighting& sighting,
                       double offset_mm) {
    const double true_s = plant::exposed_s(model.deviation, sighting.stamp_s);
    const double middle_mm = place.seen_s_mm(true_s) + offset_mm;
    const plant::ActualCamera camera = camera_at(model, true_s, middle_mm);
    const Eigen::Vector2d beside_mm = plant::tag_offset_mm(model.deviation, sighting.centre_mm);
    CornerValues corners = seen(camera, sighting, middle_mm, beside_mm);
    if (model.deviation.readout_s == 0.0) return corners;
    for (int round = 0; round < linear_rounds; ++round)
        for (int c = 0; c < corner_count; ++c) {
            const double v_px = std::clamp(corners[2 * c + 1], 0.0, model.camera.geometry.height_px - 1.0);
            const double late_s = plant::row_delay_s(model.camera.geometry, model.deviation, v_px);
            corners.segment<2>(2 * c) =
                camera.image_px(sighting.corners_mm[static_cast<std::size_t>(c)] + beside_mm,
                                place.seen_s_mm(true_s + late_s) + offset_mm);
        }
    return corners;
}

/// Normal of the reflection that turns the direction of the slope into the first axis. The slope never has
/// that direction itself, because all corners move.
CornerValues mirror_of(const CornerValues& slope) {
    return (slope.normalized() - CornerValues::Unit(0)).normalized();
}

/// Times at which the rows of a tag's corners are exposed, relative to the middle of the frame.
Eigen::Vector4d row_delays_s(const TagSighting& sighting, const CameraGeometry& camera, double readout_s) {
    plant::CameraDeviation deviation;
    deviation.readout_s = readout_s;
    Eigen::Vector4d late_s;
    for (int c = 0; c < corner_count; ++c)
        late_s[c] = plant::row_delay_s(camera, deviation, sighting.corners_px[2 * c + 1]);
    return late_s;
}

/// Adds to the floors that the error of s changes by `changed_mm` from the first corner's time to the last
/// one's.
void add_change(TagSighting& sighting, const CornerValues& slope, const Eigen::Vector4d& late_s,
                double changed_mm) {
    CornerValues off_px = slope * changed_mm / (late_s.maxCoeff() - late_s.minCoeff());
    for (int c = 0; c < corner_count; ++c) off_px.segment<2>(2 * c) *= late_s[c] - late_s.mean();
    sighting.floors_px = (sighting.floors_px.cwiseAbs2() + turned(sighting, off_px).cwiseAbs2()).cwiseSqrt();
}

/// Leaves out the rows next to a pause of the Hall readings: lines through the readings of one side only tell
/// the platform's position less precisely than lines through both (gap/links/hall_smoothing.h).
void leave_out_rims(const Recording& recording, const PlatformRun& platform, std::vector<bool>& usable) {
    constexpr std::size_t rim_rows = half_widths.back() / 2;
    constexpr double longest_ticks = 10.5;
    std::size_t last = 0;  // latest row with a reading
    for (std::size_t k = 1; k < usable.size(); ++k) {
        if (std::isnan(platform.hall_adc[k])) continue;
        const double pause_s = seconds(recording.rows[k].time_ns - recording.rows[last].time_ns);
        if (pause_s > longest_ticks * recording.tick_s)
            for (std::size_t row = last - std::min(last, rim_rows);
                 row < std::min(usable.size(), k + rim_rows); ++row)
                usable[row] = false;
        last = k;
    }
}

std::vector<WindowRows> window_rows(const Recording& recording, const CarriageRun& carriage,
                                    const PlatformRun* platform) {
    std::vector<bool> usable(recording.rows.size(), false);
    for (const auto& windows : carriage.windows)
        for (std::size_t k = windows.front().lead; k < windows.back().end; ++k)
            usable[k] = platform == nullptr || std::isfinite(platform->hall_adc[k]);
    if (platform != nullptr) leave_out_rims(recording, *platform, usable);
    std::vector<WindowRows> found;
    for (const Stretch& stretch : stretches(recording, usable))
        for (const WindowRows& window : cut(stretch, recording.tick_s, LeadIn::estimates_state))
            found.push_back(window);
    return found;
}

}  // namespace

TagRun tag_run(const Recording& recording, const Rig& rig, const CarriagePath& path,
               const CarriageRun& carriage, const PlatformRun* platform, const SmoothedReading* reading,
               const TagNoise& noise) {
    TagRun run;
    if (recording.rows.empty() || recording.detections.empty()) return run;
    const plant::ActualCamera camera{rig.camera->geometry};
    run.tick_s = recording.tick_s;
    run.is_seen = recording.is_seen;
    const TimeNs start_ns = recording.rows.front().time_ns;
    for (const StageRow& row : recording.rows) run.time_s.push_back(seconds(row.time_ns - start_ns));
    std::vector<double> way_mm{0.0};
    for (const double speed : path.velocity_mm_per_s)
        way_mm.push_back(way_mm.back() + recording.tick_s * std::abs(speed));
    const double tau_s = time_constant_s(rig.macro, rig.tick_s);
    const double hidden_mm = hidden_count * rig.macro.encoder_resolution_mm;

    for (const TagDetection& detection : recording.detections) {
        TagSighting sighting;
        sighting.stamp_s = seconds(detection.time_ns - start_ns);
        if (const auto tag = plate_tag(recording, rig, detection.tag_id)) {
            sighting.is_known = true;
            sighting.centre_mm = tag->centre_mm;
            sighting.corners_mm = plate_corners_mm(*tag);
        }
        for (int c = 0; c < corner_count; ++c)
            sighting.corners_px.segment<2>(2 * c) = detection.corners_px[static_cast<std::size_t>(c)];
        run.sightings.push_back(sighting);
    }
    const auto sighting_at = [&](std::size_t row) {
        return static_cast<std::size_t>(
            std::ranges::lower_bound(run.sightings, run.time_s[row], {}, &TagSighting::stamp_s) -
            run.sightings.begin());
    };
    for (const WindowRows& rows : window_rows(recording, carriage, platform)) {
        const std::size_t last = rows.end - 1;
        TagWindow window{rows, sighting_at(rows.lead), sighting_at(rows.first), sighting_at(last)};
        if (window.end == window.first) continue;
        double weights = 0.0, weighted_strayed = 0.0, weighted_platform = 0.0;  // units: 1/px^2, 1/px^2, 1
        for (std::size_t i = window.lead; i < window.end; ++i) {
            TagSighting& sighting = run.sightings[i];
            const Moment at = moment_at(run.time_s, run.tick_s, sighting.stamp_s);
            CornerValues slope = seen_slope(camera, sighting, path.position_mm[at.row]);
            const double platform_mm = reading ? reading->std_lsb[at.row] * mm_per_lsb(rig.micro->hall) : 0.0;
            const double strayed_mm = std::min(hidden_mm, way_share * (way_mm[at.row] - way_mm[rows.lead]));
            const double platform_px = slope.norm() * platform_mm, strayed_px = slope.norm() * strayed_mm;
            if (i < window.first) {
                // An error of the start of the simulation that leads into the window dies out.
                const double since_s = sighting.stamp_s - run.time_s[rows.lead];
                const double begun_px = slope.norm() * hidden_mm * std::exp(-since_s / tau_s);
                const double strayed_square = noise.corner_px * noise.corner_px + strayed_px * strayed_px;
                const double weight = 1.0 / (strayed_square + begun_px * begun_px);
                sighting.offset_weight = weight;
                weights += weight;
                weighted_strayed += weight * weight * strayed_square;
                weighted_platform += weight * platform_px * platform_px;
                continue;
            }
            const double offset_px =
                weights > 0.0 ? std::sqrt((weighted_strayed / weights + weighted_platform) / weights)
                              : slope.norm() * hidden_mm;
            sighting.slope_px_per_mm = slope.norm();
            sighting.mirror = mirror_of(slope);
            sighting.floors_px = CornerValues::Constant(noise.corner_px);
            sighting.floors_px[0] =
                std::hypot(std::hypot(noise.corner_px, offset_px), std::hypot(platform_px, strayed_px));
            if (noise.readout_s == 0.0) continue;
            const Eigen::Vector4d late_s = row_delays_s(sighting, rig.camera->geometry, noise.readout_s);
            const std::size_t from =
                                  nearest_row(run.time_s, run.tick_s, sighting.stamp_s + late_s.minCoeff()),
                              to = nearest_row(run.time_s, run.tick_s, sighting.stamp_s + late_s.maxCoeff());
            const double by_reading_mm =
                reading ? changed_lsb(*reading, from, to) * mm_per_lsb(rig.micro->hall) : 0.0;
            add_change(sighting, slope, late_s,
                       std::hypot(by_reading_mm, way_share * std::abs(way_mm[to] - way_mm[from])));
        }
        run.windows.push_back(window);
    }
    return run;
}

TagModel tag_model(const plant::PlantParameters& parameters, const Rig& rig) {
    FIDSERVO_DEMAND(rig.camera && parameters.camera);
    return {rig.camera->geometry,
            plant::actual_camera(rig.camera->geometry, *parameters.camera),
            *parameters.camera,
            rig.camera->exposure_s,
            rig.macro.encoder_resolution_mm,
            parameters.micro,
            parameters.axis.drive_gain};
}

CornerValues turned(const TagSighting& sighting, const CornerValues& values) {
    return values - 2.0 * sighting.mirror.dot(values) * sighting.mirror;
}

double zero_offset_mm(const TagModel& model, const TagRun& run, const CarriagePath& path,
                      const SmoothedReading* reading) {
    if (!run.zero_is_seen) return 0.0;
    constexpr std::size_t most = 201;
    const CameraPlace place(model, run, path, reading);
    const std::size_t step = 1 + run.sightings.size() / most;
    double offset_mm = 0.0;
    // The image of a tag is not quite linear in the position.
    for (int round = 0; round < linear_rounds; ++round) {
        std::vector<double> found_mm;
        for (std::size_t i = 0; i < run.sightings.size(); i += step) {
            const TagSighting& sighting = run.sightings[i];
            if (!sighting.is_known) continue;
            const CornerValues error = predicted(model, place, sighting, offset_mm) - sighting.corners_px;
            const CornerValues slope =
                seen_slope(model.camera, sighting, place.s_mm(sighting.stamp_s) + offset_mm);
            const double beside_mm = -slope.dot(error) / slope.squaredNorm();
            if (std::isfinite(beside_mm)) found_mm.push_back(beside_mm);
        }
        if (found_mm.empty()) return 0.0;
        offset_mm += median_of(std::move(found_mm));
    }
    return offset_mm;
}

std::vector<CornerValues> tag_errors(const TagModel& model, const TagRun& run, const TagWindow& window,
                                     const CarriagePath& path, const SmoothedReading* reading,
                                     double zero_mm) {
    const CameraPlace place(model, run, path, reading);
    double pull = 0.0, stiffness = 0.0;
    for (std::size_t i = window.lead; i < window.first; ++i) {
        const TagSighting& sighting = run.sightings[i];
        if (!sighting.is_known) continue;
        const double into_window_mm = zero_mm + place.entering_mm(sighting.stamp_s);
        const CornerValues error = predicted(model, place, sighting, into_window_mm) - sighting.corners_px;
        const CornerValues slope = seen_slope(model.camera, sighting, place.s_mm(sighting.stamp_s) + zero_mm);
        pull += sighting.offset_weight * slope.dot(error);
        stiffness += sighting.offset_weight * slope.squaredNorm();
    }
    const double offset_mm =
        zero_mm +
        (stiffness > 0.0 ? std::clamp(-pull / stiffness, -model.resolution_mm, model.resolution_mm) : 0.0);
    std::vector<CornerValues> errors;
    for (std::size_t i = window.first; i < window.end; ++i) {
        const TagSighting& sighting = run.sightings[i];
        if (sighting.is_known)
            errors.push_back(
                turned(sighting, predicted(model, place, sighting, offset_mm) - sighting.corners_px));
        else
            errors.push_back(CornerValues::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    return errors;
}

}  // namespace fidservo::gap
